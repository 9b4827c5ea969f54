// The rules of the tree hold (tools/check_tree.py prints every violation).
#include "app/program.h"

namespace crescente::test {
namespace {

TEST(Tree, IsInOrder) {
    const Outcome outcome = Running({"python3", CRESCENTE_ROOT "/tools/check_tree.py"}, {}).finish();
    if (outcome.code == 127) GTEST_SKIP() << "python3 is not installed";
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace crescente::test
