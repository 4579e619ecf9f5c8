#include "semantic_mht_slam/common/state_archive.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

#include "support/expect_input_error.h"

namespace semantic_mht_slam {
namespace {

/// What a value becomes on its way through bytes.
template <class Value>
Value throughBytes(Value value, std::size_t* size = nullptr) {
  StateArchive writer;
  writer(value);
  if (size != nullptr) *size = writer.written().size();
  StateArchive reader(writer.written());
  Value result{};
  reader(result);
  reader.requireEnd();
  return result;
}

TEST(StateArchiveTest, IntegersOfEverySizeComeBackAndSmallOnesAreShort) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{63}, std::int64_t{-64},
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(throughBytes(value), value);
  }
  EXPECT_EQ(throughBytes(std::numeric_limits<std::uint64_t>::max()), std::numeric_limits<std::uint64_t>::max());
  std::size_t size = 0;
  throughBytes(-64, &size);
  EXPECT_EQ(size, 1U);
}

TEST(StateArchiveTest, MatricesOfEveryFormComeBackBitForBit) {
  Rng rng(1);
  Eigen::Matrix3d full;
  for (int i = 0; i < 9; ++i) full(i) = rng.normal();
  const Eigen::Matrix3d symmetric = full + full.transpose();
  const Eigen::Matrix3d upper = full.triangularView<Eigen::Upper>();
  const Eigen::Matrix3d diagonal = full.diagonal().asDiagonal();
  std::size_t sizes[5];
  EXPECT_EQ(throughBytes(full, &sizes[0]), full);
  EXPECT_EQ(throughBytes(symmetric, &sizes[1]), symmetric);
  EXPECT_EQ(throughBytes(upper, &sizes[2]), upper);
  EXPECT_EQ(throughBytes(diagonal, &sizes[3]), diagonal);
  EXPECT_EQ(throughBytes(Eigen::Matrix3d(Eigen::Matrix3d::Zero()), &sizes[4]), Eigen::Matrix3d::Zero());
  EXPECT_EQ(sizes[0], 73U);
  EXPECT_EQ(sizes[1], 49U);
  EXPECT_EQ(sizes[2], 49U);
  EXPECT_EQ(sizes[3], 25U);
  EXPECT_EQ(sizes[4], 1U);
}

TEST(StateArchiveTest, ContainersOfContainersComeBack) {
  const std::map<int, std::vector<std::optional<std::string>>> value = {{-3, {"a", std::nullopt}}, {7, {}}};
  EXPECT_EQ(throughBytes(value), value);
  const std::vector<bool> flags = {true, false, true};
  EXPECT_EQ(throughBytes(flags), flags);
  EXPECT_EQ(throughBytes(std::set<int>{5, 1}), (std::set<int>{5, 1}));
}

TEST(StateArchiveTest, BytesThatAreNoSuchValueAreRefused) {
  std::vector<double> list(3, 1.5);
  StateArchive writer;
  writer(list);
  const std::string short_bytes = writer.written().substr(0, writer.written().size() - 1);
  expectInputError([&] { StateArchive(std::string_view(short_bytes))(list); }, {"ends too early"});
  const std::string long_list("\xFF\xFF\xFF\x7F", 4);
  expectInputError([&] { StateArchive(std::string_view(long_list))(list); }, {"longer than its state"});
  std::int64_t large = 1LL << 40;
  StateArchive wide;
  wide(large);
  int narrow = 0;
  expectInputError([&] { StateArchive(std::string_view(wide.written()))(narrow); }, {"out of range"});
}

TEST(StateArchiveTest, AMatrixOfAnotherShapeThanItsTypeHasIsRefused) {
  for (auto [rows, cols] : {std::pair<Eigen::Index, Eigen::Index>{3, 0}, {3, 2}, {-1, 1}, {1 << 20, 1}}) {
    StateArchive writer;
    writer(rows, cols);
    const std::string bytes = writer.written() + std::string(64, '\0');
    Eigen::VectorXd column = Eigen::VectorXd::Zero(2);
    expectInputError([&] { StateArchive(std::string_view(bytes))(column); }, {"impossible size"});
    EXPECT_EQ(column.size(), 2);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
