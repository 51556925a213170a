// Tables by column name, and messages that lead to the wrong cell.
#include "sim/files/csv.hpp"

#include <gmock/gmock.h>

#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Csv, ReadsColumnsByName) {
  const TemporaryFile file("table.csv", "time_s,part,x\n0,body,-1.5\n0.5,\"wheel, left\",+2e3\n1, axle ,.25\n");
  const CsvTable table(file.path());
  EXPECT_THAT(table.columns(), ElementsAre("time_s", "part", "x"));
  EXPECT_EQ(table.rows(), 3u);
  EXPECT_THAT(table.numbers("x"), ElementsAre(-1.5, 2000, 0.25));
  EXPECT_THAT(table.numbers("time_s"), ElementsAre(0, 0.5, 1));
  EXPECT_THAT(table.text("part"), ElementsAre("body", "wheel, left", "axle"));
  EXPECT_TRUE(table.has("part"));
  EXPECT_FALSE(table.has("y"));
}

TEST(Csv, AcceptsSemicolonsWindowsLineEndsByteOrderMarkAndAnyExtension) {
  const TemporaryFile file("table.dat", "\xEF\xBB\xBFu_ms;v_ms\r\n1.25;-2\r\n3;4\r\n");
  const CsvTable table(file.path());
  EXPECT_THAT(table.numbers("u_ms"), ElementsAre(1.25, 3));
  EXPECT_THAT(table.numbers("v_ms"), ElementsAre(-2, 4));
}

TEST(Csv, ReadsDatesToTheMillisecond) {
  const TemporaryFile file(
      "table.csv",
      "timestamp,u\n1970-01-02 00:00:00.000,1\n2023-05-12 17:30:00.050,2\n2023-05-12T19:30:00.100+02:00,3\n");
  const std::vector<double> times = CsvTable(file.path()).times("timestamp");
  EXPECT_EQ(times[0], 86400);
  EXPECT_NEAR(times[1], 1683912600.05, 1e-5);
  EXPECT_NEAR(times[2] - times[1], 0.05, 1e-5);
}

TEST(Csv, NamesFileLineColumnAndValue) {
  const TemporaryFile file("table.csv", "a,b\n1,2\n3,four\n5,\n6,nan\n");
  const CsvTable table(file.path());
  const auto read = [&] { table.numbers("b"); };
  EXPECT_THAT(message_of(ErrorKind::invalid_input, read),
              AllOf(HasSubstr("table.csv:3"), HasSubstr("'b'"), HasSubstr("'four'"), HasSubstr("a finite number")));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { table.times("b"); }), HasSubstr("date and time"));
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { table.numbers("c"); }),
              AllOf(HasSubstr("no column 'c'"), HasSubstr("a, b")));
}

TEST(Csv, RejectsCellsThatAreNoFiniteNumbers) {
  for (const char* cell : {"", "nan", "inf", "1e999", "1,5x", "0x10", "1 2", "--1"}) {
    const TemporaryFile file("table.csv", std::string("a;b\n\"") + cell + "\";1\n");
    EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { CsvTable(file.path()).numbers("a"); }),
                HasSubstr("table.csv:2"))
        << cell;
  }
}

TEST(Csv, CountsBlankLines) {
  const TemporaryFile file("table.csv", "a,b\n1,2\n\n\n3,x\n");
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { CsvTable(file.path()).numbers("b"); }),
              AllOf(HasSubstr("table.csv:5"), HasSubstr("'x'")));
}

TEST(Csv, RejectsWhatIsNoTable) {
  EXPECT_THAT(message_of(ErrorKind::input_output, [] { CsvTable("/nowhere/wind.csv"); }),
              HasSubstr("/nowhere/wind.csv: not readable"));
  EXPECT_THAT(message_of(ErrorKind::input_output, [] { CsvTable("/tmp"); }), HasSubstr("/tmp: not readable"));
  for (const char* text : {"", "a,b\n", "alone\n1\n", "\n\n", "\x89PNG\r\n\x1a\n"}) {
    const TemporaryFile file("table.csv", text);
    EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { CsvTable(file.path()); }),
                HasSubstr("allowed: a header line"))
        << text;
  }
}

}  // namespace
}  // namespace understory
