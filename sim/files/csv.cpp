// GDAL's CSV driver reads every cell as text; numbers and dates are parsed here, strictly, to name the cell that is
// wrong.
#include "sim/files/csv.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>

#include "sim/error.hpp"

namespace understory {
namespace {

/// GDAL's messages go into our own error instead of onto standard error.
class QuietGdal {
 public:
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
struct DestroyFeature {
  void operator()(void* feature) const { OGR_F_Destroy(feature); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;
using Feature = std::unique_ptr<void, DestroyFeature>;

[[noreturn]] void reject_table(const std::filesystem::path& file) {
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("{}: no table of values, allowed: a header line naming two or more columns, separated by comma, "
                  "semicolon or tab, and at least one row",
                  file.string()));
}

Dataset open_csv(const std::filesystem::path& file) {
  static std::once_flag registered;
  std::call_once(registered, [] { OGRRegisterAll(); });
  const char* const drivers[] = {"CSV", nullptr};
  const char* const options[] = {"HEADERS=YES", "AUTODETECT_TYPE=NO", nullptr};
  // The prefix lets any file name extension through.
  const std::string name = "CSV:" + file.string();
  Dataset dataset(GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers, options, nullptr));
  if (!dataset) reject_table(file);
  return dataset;
}

/// Numbers, counted from 1, of the lines that are not empty: the driver skips the others without counting them.
std::vector<std::size_t> filled_lines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!std::filesystem::is_regular_file(file) || !stream)
    throw Error(ErrorKind::input_output, fmt::format("{}: not readable as a file", file.string()));
  std::vector<std::size_t> numbers;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number)
    if (!line.empty() && line != "\r") numbers.push_back(number);
  return numbers;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> number(const std::string& cell) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const char* begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
  const auto [stop, problem] = std::from_chars(begin, end, value);
  if (problem != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Seconds since 1970.
std::optional<double> date_and_time(const std::string& cell) {
  OGRField field;
  if (!OGRParseDate(cell.c_str(), &field, 0)) return std::nullopt;
  const auto date = std::chrono::year(field.Date.Year) / field.Date.Month / field.Date.Day;
  if (!date.ok()) return std::nullopt;
  const double days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  // Zone flag: 100 is UTC, each step 15 minutes; 0 and 1 say nothing or local time.
  const int zone_minutes = field.Date.TZFlag > 1 ? (field.Date.TZFlag - 100) * 15 : 0;
  const int minutes = field.Date.Hour * 60 + field.Date.Minute - zone_minutes;
  return days * 86400 + minutes * 60 + static_cast<double>(field.Date.Second);
}

[[noreturn]] void reject(const CsvTable& table, const std::string& column, std::size_t row,
                         const std::string& allowed) {
  throw Error(ErrorKind::invalid_input, fmt::format("{}:{}: column '{}': '{}', allowed: {}", table.file().string(),
                                                    table.line(row), column, table.text(column)[row], allowed));
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file) : file_(file), lines_(filled_lines(file)) {
  const QuietGdal quiet;
  const Dataset dataset = open_csv(file);
  const OGRLayerH layer = GDALDatasetGetLayer(dataset.get(), 0);
  if (!layer) reject_table(file);
  const OGRFeatureDefnH fields = OGR_L_GetLayerDefn(layer);
  const int count = OGR_FD_GetFieldCount(fields);
  for (int i = 0; i < count; ++i) columns_.push_back(trimmed(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(fields, i))));
  cells_.resize(columns_.size());
  std::size_t rows = 0;
  while (const Feature feature{OGR_L_GetNextFeature(layer)}) {
    for (int i = 0; i < count; ++i) cells_[i].push_back(trimmed(OGR_F_GetFieldAsString(feature.get(), i)));
    ++rows;
  }
  if (rows == 0 || columns_.size() < 2) reject_table(file);
  lines_.erase(lines_.begin());  // the header's
  // A quoted line break makes fewer rows than lines; line ends of a lone carriage return make more.
  lines_.resize(rows, lines_.empty() ? 1 : lines_.back());
}

bool CsvTable::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

const std::vector<std::string>& CsvTable::text(const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end())
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}:1: no column '{}'; there are: {}", file_.string(), column, fmt::join(columns_, ", ")));
  return cells_[static_cast<std::size_t>(found - columns_.begin())];
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  const std::vector<std::string>& cells = text(column);
  std::vector<double> values(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    const std::optional<double> value = number(cells[row]);
    if (!value) reject(*this, column, row, "a finite number");
    values[row] = *value;
  }
  return values;
}

std::vector<double> CsvTable::times(const std::string& column) const {
  const std::vector<std::string>& cells = text(column);
  std::vector<double> values(cells.size());
  for (std::size_t row = 0; row < cells.size(); ++row) {
    std::optional<double> value = number(cells[row]);
    if (!value) value = date_and_time(cells[row]);
    if (!value) reject(*this, column, row, "seconds, or date and time like 2023-05-12 17:30:00.050");
    values[row] = *value;
  }
  return values;
}

}  // namespace understory
