#include "semantic_mht_slam/mapping/class_confusion.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

TEST(ClassConfusionTest, BeginsWithWrongClassesSpreadEvenly) {
  const ClassConfusion confusion(5, 0.2, 100.0);
  EXPECT_NEAR(confusion.prob(3, 3), 0.8, 1e-12);
  EXPECT_NEAR(confusion.prob(1, 3), 0.05, 1e-12);
  EXPECT_NEAR(ClassConfusion(1, 0.2, 100.0).prob(0, 0), 1.0, 1e-12);
}

TEST(ClassConfusionTest, LearnsWhichClassesAreTakenForEachOther) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    ClassConfusion confusion(4, 0.1, 100.0);
    Rng rng(seed);
    for (int i = 0; i < 20000; ++i) confusion.add(1, rng.bernoulli(0.2) ? 2 : 1);
    EXPECT_NEAR(confusion.prob(2, 1), 0.2, 0.02);
    EXPECT_LT(confusion.prob(3, 1), 0.001);
    EXPECT_GT(confusion.prob(3, 1), 0.0);  // never impossible
    EXPECT_NEAR(confusion.prob(1, 2), 0.1 / 3.0, 1e-12) << "of another class nothing was learned";
  }
}

TEST(ClassConfusionTest, ProbabilitiesOfEveryObjectSumToOne) {
  ClassConfusion confusion(4, 0.1, 10.0);
  Rng rng(7);
  for (int i = 0; i < 500; ++i) confusion.add(static_cast<int>(rng.index(4)), static_cast<int>(rng.index(4)));
  for (int object = 0; object < 4; ++object) {
    double sum = 0.0;
    for (int detected = 0; detected < 4; ++detected) sum += confusion.prob(detected, object);
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(ClassConfusionTest, RefusesAClassThatIsNotThere) {
  ClassConfusion confusion(4, 0.1, 10.0);
  EXPECT_THROW(confusion.add(4, 0), std::invalid_argument);
  EXPECT_THROW(confusion.add(0, -1), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
