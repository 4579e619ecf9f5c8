#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace semantic_mht_slam {

/// Writes the wire format of protocol buffers, as far as an ONNX file of one layer needs it.
class ProtobufWriter {
 public:
  ProtobufWriter& integer(std::uint32_t field, std::uint64_t value) {
    key(field, 0);
    varint(value);
    return *this;
  }
  ProtobufWriter& text(std::uint32_t field, const std::string& value) {
    key(field, 2);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtobufWriter& message(std::uint32_t field, const ProtobufWriter& value) { return text(field, value.bytes_); }

  const std::string& bytes() const { return bytes_; }

 private:
  void key(std::uint32_t field, std::uint32_t wire_type) { varint(field << 3U | wire_type); }
  void varint(std::uint64_t value) {
    for (; value >= 128; value >>= 7U) bytes_ += static_cast<char>((value & 127U) | 128U);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

/// What a network of one layer does: the score of class c is weights[c] . (first, second, third channel) + biases[c].
struct TinyNetwork {
  std::vector<std::array<float, 3>> weights;
  std::vector<float> biases;
};

/// An ONNX file with one convolution of 1x1 pixels. Field numbers as in onnx.proto.
inline std::string toOnnx(const TinyNetwork& network) {
  constexpr int kFloat = 1;
  const auto classes = network.biases.size();
  const auto tensor = [](const std::string& name, const std::vector<std::uint64_t>& shape, const void* data,
                         std::size_t bytes) {
    ProtobufWriter writer;
    for (const std::uint64_t size : shape) writer.integer(1, size);
    return writer.integer(2, kFloat).text(8, name).text(9, std::string(static_cast<const char*>(data), bytes));
  };
  const auto value = [](const std::string& name, const std::vector<std::uint64_t>& shape) {
    ProtobufWriter dimensions;
    for (const std::uint64_t size : shape) dimensions.message(1, ProtobufWriter().integer(1, size));
    const ProtobufWriter type = ProtobufWriter().message(1, ProtobufWriter().integer(1, kFloat).message(2, dimensions));
    return ProtobufWriter().text(1, name).message(2, type);
  };
  constexpr int kInts = 7;
  const ProtobufWriter kernel = ProtobufWriter().text(1, "kernel_shape").integer(8, 1).integer(8, 1).integer(20, kInts);
  const ProtobufWriter node = ProtobufWriter()
                                  .text(1, "image")
                                  .text(1, "weights")
                                  .text(1, "biases")
                                  .text(2, "scores")
                                  .text(3, "layer")
                                  .text(4, "Conv");
  const ProtobufWriter node_with_kernel = ProtobufWriter(node).message(5, kernel);
  const ProtobufWriter graph =
      ProtobufWriter()
          .message(1, node_with_kernel)
          .text(2, "tiny")
          .message(5, tensor("weights", {classes, 3, 1, 1}, network.weights.data(), classes * 3 * sizeof(float)))
          .message(5, tensor("biases", {classes}, network.biases.data(), classes * sizeof(float)))
          .message(11, value("image", {1, 3, 8, 8}))
          .message(12, value("scores", {1, classes, 8, 8}));
  return ProtobufWriter()
      .integer(1, 7)
      .text(2, "test")
      .message(7, graph)
      .message(8, ProtobufWriter().text(1, "").integer(2, 11))
      .bytes();
}

/// A network that tells red (id 0), green (1) and blue (2) pixels apart, for an input of red, green, blue in [0, 1].
inline TinyNetwork makeColorNetwork() {
  return {{{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}}, {0.0F, 0.0F, 0.0F}};
}

}  // namespace semantic_mht_slam
