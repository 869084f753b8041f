// The validation table: what passes, what does not, and that a missed bar is said.
#include "sim/validation/check.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

using State = ValidationRow::State;

TEST(Validation, ABarIsABar) {
    EXPECT_EQ(compare("x", "y", 101.9, 100, 0.02, "ns").state, State::passed);
    EXPECT_EQ(compare("x", "y", 98.1, 100, 0.02, "ns").state, State::passed);
    EXPECT_EQ(compare("x", "y", 102.1, 100, 0.02, "ns").state, State::missed);
    EXPECT_EQ(compare("x", "y", 97.9, 100, 0.02, "ns").state, State::missed);
    EXPECT_EQ(compare("x", "y", 97.9, 100, 0.02, "ns").measured, "97.9 ns for 100: -2.10 %");
    EXPECT_EQ(compare("x", "y", 0.0 / 0.0, 100, 0.02, "ns").state, State::missed) << "no number";
    EXPECT_EQ(exact("x", "y", 3, 0, "").state, State::passed);
    EXPECT_EQ(exact("x", "y", 3, 1, "b").state, State::missed);
    EXPECT_EQ(exact("x", "y", 0, 0, "").state, State::missed) << "nothing was compared";
    ValidationRow row;
    for (State s : {State::passed, State::reported, State::tests, State::unbuilt}) {
        row.state = s;
        EXPECT_EQ(exit_code({row, row}), 0) << name_of(s);
    }
    ValidationRow missed;
    missed.state = State::missed;
    EXPECT_EQ(exit_code({row, missed, row}), 1);
}

TEST(Validation, TheReferenceModesFormsPass) {
    const std::vector<ValidationRow> rows = check_reference();
    EXPECT_EQ(rows.size(), 8U);
    for (const ValidationRow& row : rows)
        EXPECT_EQ(row.state, State::passed) << row.what << ": " << row.measured;
}

TEST(Validation, TheTlbsFormsPass) {
    const std::vector<ValidationRow> rows = check_tlb();
    EXPECT_EQ(rows.size(), 7U);
    for (const ValidationRow& row : rows)
        EXPECT_EQ(row.state, State::passed) << row.what << ": " << row.measured;
}

TEST(Validation, CoherencesFormsPass) {
    const std::vector<ValidationRow> rows = check_coherence();
    EXPECT_EQ(rows.size(), 132U);
    for (const ValidationRow& row : rows)
        EXPECT_EQ(row.state, State::passed) << row.what << ": " << row.measured;
}

TEST(Validation, ClosedFormsPass) {
    for (const std::vector<ValidationRow>& rows : {check_core(), check_network(), check_dram()}) {
        EXPECT_GT(rows.size(), 13U);
        for (const ValidationRow& row : rows)
            EXPECT_EQ(row.state, row.bar == "none" ? State::reported : State::passed)
                << row.what << ": " << row.measured << ", bar " << row.bar;
    }
}

} // namespace
} // namespace sim::test
