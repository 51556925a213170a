// Tables of comma (or semicolon, or tab) separated values with a header line, read by column name.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace understory {

class CsvTable {
 public:
  /// Throws Error(input_output) when the file cannot be read, Error(invalid_input) when it holds no table.
  explicit CsvTable(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t rows() const { return lines_.size(); }
  /// Line in the file of a row, counted from 1 (the header's), for messages.
  std::size_t line(std::size_t row) const { return lines_[row]; }
  bool has(const std::string& column) const;

  /// One entry per row. Throw Error(invalid_input) naming file, line, column and value.
  const std::vector<std::string>& text(const std::string& column) const;
  std::vector<double> numbers(const std::string& column) const;  // finite
  /// Seconds: numbers as they are, else date and time as `2023-05-12 17:30:00.050` or ISO 8601, since 1970.
  std::vector<double> times(const std::string& column) const;

 private:
  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> cells_;  // [column][row]
  std::vector<std::size_t> lines_;               // [row]
};

}  // namespace understory
