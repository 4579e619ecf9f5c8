#include "semantic_mht_slam/app/refused_input.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(RefusedInputTest, OfManyUnknownClassesTenAreListedAndTheOthersCounted) {
  RefusedInput refused;
  for (int id = 0; id < 65536; ++id) refused.unknown_classes[id] = id == 300 ? 9 : 1;
  const UnknownClassList list = listOf(refused.unknown_classes);
  EXPECT_EQ(list.listed.size(), 10U);
  EXPECT_EQ(list.listed.at(300), 9U) << "the one of most objects";
  EXPECT_EQ(list.others, 65526U);
  EXPECT_EQ(list.objects_of_others, 65526U);
  EXPECT_EQ(list.text(), "class ids 0, 1, 2, 3, 4, 5, 6, 7, 8, 300 and 65526 more");
  const std::vector<std::string> lines = droppedInput({}, refused, {});
  ASSERT_EQ(lines.size(), 11U);
  EXPECT_EQ(lines[9], "objects: 9 objects dropped: class id '300' is not in the class table");
  EXPECT_EQ(lines[10],
            "objects: 65526 objects dropped: of other class ids that are not in the class table, 65526 more");
}

TEST(RefusedInputTest, FewUnknownClassesAreAllListed) {
  EXPECT_EQ(listOf({}).text(), "");
  EXPECT_EQ(listOf({{7, 2}}).text(), "class id 7");
  EXPECT_EQ(listOf({{7, 2}, {99, 1}}).text(), "class ids 7, 99");
  RefusedInput refused;
  refused.unknown_classes = {{7, 2}, {99, 1}};
  EXPECT_EQ(droppedInput({}, refused, {}),
            (std::vector<std::string>{"objects: 2 objects dropped: class id '7' is not in the class table",
                                      "objects: 1 objects dropped: class id '99' is not in the class table"}));
}

}  // namespace
}  // namespace semantic_mht_slam
