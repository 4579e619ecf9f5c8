#include "semantic_mht_slam/simulation/street_network.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace semantic_mht_slam {
namespace {

/// A street of the full grid. `line` is the number of its row or column, `place` its number on that line.
struct GridStreet {
  bool horizontal = true;
  int line = 0;
  int place = 0;
};

Terrain makeTerrain(const StreetNetworkConfig& config, Rng rng) {
  Terrain terrain;
  for (Terrain::Wave& wave : terrain.waves) {
    const double direction = rng.uniform(0.0, 2.0 * M_PI);
    const double wavelength = config.hill_length_m * rng.uniform(1.0, 2.5);
    wave.wave_vector_rad_per_m = 2.0 * M_PI / wavelength * Eigen::Vector2d(std::cos(direction), std::sin(direction));
    wave.phase_rad = rng.uniform(0.0, 2.0 * M_PI);
    wave.amplitude_m = config.hill_height_m / static_cast<double>(terrain.waves.size());
  }
  return terrain;
}

std::vector<double> makeLines(int count, double distance_m, double irregularity, Rng& rng) {
  std::vector<double> lines(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i] = distance_m * (static_cast<double>(i) + irregularity * rng.uniform(-1.0, 1.0));
  }
  return lines;
}

/// Corners share the shift of their row and column and have a smaller one of their own: streets stay nearly straight.
std::vector<Eigen::Vector2d> makeNodes(const StreetNetworkConfig& config, Rng rng) {
  const std::vector<double> x = makeLines(config.columns, config.block_width_m, 0.75 * config.irregularity, rng);
  const std::vector<double> y = makeLines(config.rows, config.block_depth_m, 0.75 * config.irregularity, rng);
  const double own = 0.25 * config.irregularity;
  std::vector<Eigen::Vector2d> nodes;
  for (const double node_y : y) {
    for (const double node_x : x) {
      nodes.emplace_back(node_x + own * config.block_width_m * rng.uniform(-1.0, 1.0),
                         node_y + own * config.block_depth_m * rng.uniform(-1.0, 1.0));
    }
  }
  return nodes;
}

/// Straight at both ends, so that streets meet at corners in the direction of their chords.
std::vector<Eigen::Vector2d> makeCenterLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double bend_m) {
  const int count = std::max(2, static_cast<int>(std::ceil((to - from).norm())));
  const Eigen::Vector2d left = leftOf((to - from).normalized());
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= count; ++i) {
    const double fraction = static_cast<double>(i) / count;
    const double sine = std::sin(M_PI * fraction);
    points.push_back(from + fraction * (to - from) + bend_m * sine * sine * left);
  }
  return points;
}

double lengthOf(const std::vector<Eigen::Vector2d>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

StreetType drawType(const GridStreet& place, const StreetNetworkConfig& config, Rng& rng) {
  const bool green = rng.bernoulli(config.green_prob);  // drawn for main roads too, so that they shift nothing
  if (config.main_road_every > 0 && place.line % config.main_road_every == config.main_road_every / 2) {
    return StreetType::kMain;
  }
  return green ? StreetType::kGreen : StreetType::kResidential;
}

std::vector<GridStreet> gridStreets(const StreetNetworkConfig& config) {
  std::vector<GridStreet> places;
  for (int line = 0; line < config.rows; ++line) {
    for (int place = 0; place + 1 < config.columns; ++place) places.push_back({true, line, place});
  }
  for (int line = 0; line < config.columns; ++line) {
    for (int place = 0; place + 1 < config.rows; ++place) places.push_back({false, line, place});
  }
  return places;
}

Street makeStreet(const GridStreet& place, const StreetNetworkConfig& config, const std::vector<Eigen::Vector2d>& nodes,
                  Rng& rng) {
  Street street;
  street.from =
      place.horizontal ? place.line * config.columns + place.place : place.place * config.columns + place.line;
  street.to = street.from + (place.horizontal ? 1 : config.columns);
  street.type = drawType(place, config, rng);
  street.center_line_m =
      makeCenterLine(nodes[static_cast<std::size_t>(street.from)], nodes[static_cast<std::size_t>(street.to)],
                     config.bend_m * rng.uniform(-1.0, 1.0));
  street.length_m = lengthOf(street.center_line_m);
  return street;
}

bool isConnected(const StreetNetwork& network, const std::vector<bool>& removed) {
  std::vector<bool> reached(network.nodes_m.size(), false);
  reached[0] = true;
  bool grew = true;
  while (grew) {
    grew = false;
    for (std::size_t i = 0; i < network.streets.size(); ++i) {
      const std::size_t from = static_cast<std::size_t>(network.streets[i].from);
      const std::size_t to = static_cast<std::size_t>(network.streets[i].to);
      if (removed[i] || reached[from] == reached[to]) continue;
      reached[from] = reached[to] = true;
      grew = true;
    }
  }
  return std::all_of(reached.begin(), reached.end(), [](bool node) { return node; });
}

int degree(const StreetNetwork& network, const std::vector<bool>& removed, int node) {
  int count = 0;
  for (std::size_t i = 0; i < network.streets.size(); ++i) {
    if (!removed[i] && (network.streets[i].from == node || network.streets[i].to == node)) ++count;
  }
  return count;
}

/// Numbers of the streets before removal to those after it.
std::vector<int> removeStreets(StreetNetwork& network, double prob, Rng rng) {
  std::vector<bool> removed(network.streets.size(), false);
  for (std::size_t i = 0; i < network.streets.size(); ++i) {
    if (!rng.bernoulli(prob)) continue;
    const Street& street = network.streets[i];
    if (degree(network, removed, street.from) < 3 || degree(network, removed, street.to) < 3) continue;
    removed[i] = true;
    if (!isConnected(network, removed)) removed[i] = false;
  }
  std::vector<Street> kept;
  std::vector<int> number(network.streets.size(), -1);
  for (std::size_t i = 0; i < network.streets.size(); ++i) {
    if (removed[i]) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(network.streets[i]));
  }
  network.streets = std::move(kept);
  return number;
}

void linkLookalikes(StreetNetwork& network, const std::vector<GridStreet>& places, const std::vector<int>& number,
                    double prob, Rng rng) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool alike = rng.bernoulli(prob);
    if (!alike || number[i] < 0) continue;
    for (std::size_t j = 0; j < i; ++j) {
      const bool before = places[j].horizontal == places[i].horizontal && places[j].line + 1 == places[i].line &&
                          places[j].place == places[i].place;
      if (!before || number[j] < 0) continue;
      network.streets[static_cast<std::size_t>(number[i])].lookalike_of = number[j];
      network.streets[static_cast<std::size_t>(number[i])].type =
          network.streets[static_cast<std::size_t>(number[j])].type;
    }
  }
}

}  // namespace

double Terrain::height(const Eigen::Vector2d& position_m) const {
  double sum = 0.0;
  for (const Wave& wave : waves) {
    sum += wave.amplitude_m * std::sin(wave.wave_vector_rad_per_m.dot(position_m) + wave.phase_rad);
  }
  return sum;
}

Eigen::Vector2d Terrain::gradient(const Eigen::Vector2d& position_m) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Wave& wave : waves) {
    sum += wave.amplitude_m * std::cos(wave.wave_vector_rad_per_m.dot(position_m) + wave.phase_rad) *
           wave.wave_vector_rad_per_m;
  }
  return sum;
}

double StreetNetwork::totalLength() const {
  double sum = 0.0;
  for (const Street& street : streets) sum += street.length_m;
  return sum;
}

StreetNetwork buildStreetNetwork(const StreetNetworkConfig& config, Rng rng) {
  StreetNetwork network;
  network.terrain = makeTerrain(config, rng.fork("terrain"));
  network.nodes_m = makeNodes(config, rng.fork("nodes"));
  const std::vector<GridStreet> places = gridStreets(config);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Rng street_rng = rng.fork("street", i);
    network.streets.push_back(makeStreet(places[i], config, network.nodes_m, street_rng));
  }
  const std::vector<int> number = removeStreets(network, config.removed_street_prob, rng.fork("removed"));
  linkLookalikes(network, places, number, config.lookalike_prob, rng.fork("lookalike"));
  return network;
}

StreetPoint pointOnStreet(const Street& street, double along_m) {
  const std::vector<Eigen::Vector2d>& points = street.center_line_m;
  double left_m = std::max(0.0, along_m);
  std::size_t i = 1;
  double step_m = (points[1] - points[0]).norm();
  while (i + 1 < points.size() && left_m > step_m) {
    left_m -= step_m;
    ++i;
    step_m = (points[i] - points[i - 1]).norm();
  }
  const Eigen::Vector2d direction = (points[i] - points[i - 1]) / step_m;
  return {points[i - 1] + std::min(left_m, step_m) * direction, direction};
}

}  // namespace semantic_mht_slam
