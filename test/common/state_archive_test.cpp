#include "semantic_mht_slam/common/state_archive.h"

#include <cmath>
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
  const std::string bytes = writer.written();
  if (size != nullptr) *size = bytes.size();
  StateArchive reader(bytes);
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
  EXPECT_EQ(size, 2U) << "and that there is no double";
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
  EXPECT_EQ(sizes[0], 83U);
  EXPECT_EQ(sizes[1], 56U);
  EXPECT_EQ(sizes[2], 56U);
  EXPECT_EQ(sizes[3], 29U);
  EXPECT_EQ(sizes[4], 2U);
}

TEST(StateArchiveTest, ANumberThatWasWrittenBeforeIsShort) {
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(std::sqrt(i % 100));
  values.push_back(-0.0);
  std::size_t size = 0;
  const std::vector<double> result = throughBytes(values, &size);
  EXPECT_EQ(result, values);
  EXPECT_TRUE(std::signbit(result.back()));
  EXPECT_LT(size, 101U * 8U + 401U + 10U);
}

TEST(StateArchiveTest, NumbersThatThereAreNotAreRefused) {
  double value = 0.0;
  const auto read = [&value](const std::string& bytes) {
    StateArchive reader(bytes);
    reader(value);
    reader.requireEnd();
  };
  const std::string one("\0\0\0\0\0\0\xF0\x3F", 8);
  read("\x01" + one + std::string(1, '\0'));
  EXPECT_EQ(value, 1.0);
  expectInputError([&] { read("\x02" + one + std::string(1, '\0')); }, {"more numbers than bytes"});
  expectInputError([&] { read("\x01" + one + "\x01"); }, {"repeats a number"});
  expectInputError([&] { read(std::string(2, '\0')); }, {"ends too early"});
  std::string two("\x02");
  for (const char byte : one) two += std::string(2, byte);
  expectInputError([&] { read(two + std::string(1, '\0')); }, {"numbers too many"});
}

TEST(StateArchiveTest, WhatCouldNotBeReadIsNotWritten) {
  for (double value : {std::nan(""), std::numeric_limits<double>::infinity(), -1e101}) {
    StateArchive writer;
    expectInputError([&] { writer(value); }, {"not finite, or too large"});
  }
}

TEST(StateArchiveTest, ContainersOfContainersComeBack) {
  const std::map<int, std::vector<std::optional<std::string>>> value = {{-3, {"a", std::nullopt}}, {7, {}}};
  EXPECT_EQ(throughBytes(value), value);
  const std::vector<bool> flags = {true, false, true};
  EXPECT_EQ(throughBytes(flags), flags);
  EXPECT_EQ(throughBytes(std::set<int>{5, 1}), (std::set<int>{5, 1}));
}

TEST(StateArchiveTest, BytesThatAreNoSuchValueAreRefused) {
  std::vector<int> list(3, 300);
  StateArchive writer;
  writer(list);
  const std::string bytes = writer.written();
  const std::string short_bytes = bytes.substr(0, bytes.size() - 1);
  expectInputError([&] { StateArchive(std::string_view(short_bytes))(list); }, {"ends too early"});
  const std::string long_list("\0\xFF\xFF\xFF\x7F", 5);
  expectInputError([&] { StateArchive(std::string_view(long_list))(list); }, {"longer than its state"});
  std::int64_t large = 1LL << 40;
  StateArchive wide;
  wide(large);
  int narrow = 0;
  const std::string wide_bytes = wide.written();
  expectInputError([&] { StateArchive(std::string_view(wide_bytes))(narrow); }, {"out of range"});
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
