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

Dataset open_csv(const std::filesystem::path& file) {
  static std::once_flag registered;
  std::call_once(registered, [] { OGRRegisterAll(); });
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw Error(ErrorKind::input_output, fmt::format("{}: no such file", file.string()));
  const char* const drivers[] = {"CSV", nullptr};
  const char* const options[] = {"HEADERS=YES", "AUTODETECT_TYPE=NO", nullptr};
  // The prefix lets any file name extension through.
  Dataset dataset(
      GDALOpenEx(("CSV:" + file.string()).c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers, options, nullptr));
  if (!dataset)
    throw Error(ErrorKind::input_output,
                fmt::format("{}: not readable as CSV: {}", file.string(), CPLGetLastErrorMsg()));
  return dataset;
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

CsvTable::CsvTable(const std::filesystem::path& file) : file_(file) {
  const QuietGdal quiet;
  const Dataset dataset = open_csv(file);
  const OGRLayerH layer = GDALDatasetGetLayer(dataset.get(), 0);
  const OGRFeatureDefnH fields = layer ? OGR_L_GetLayerDefn(layer) : nullptr;
  const int count = fields ? OGR_FD_GetFieldCount(fields) : 0;
  for (int i = 0; i < count; ++i) columns_.push_back(trimmed(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(fields, i))));
  cells_.resize(columns_.size());
  while (layer) {
    const Feature feature(OGR_L_GetNextFeature(layer));
    if (!feature) break;
    // The driver counts records from 1 and skips no line but the header's.
    lines_.push_back(static_cast<std::size_t>(OGR_F_GetFID(feature.get())) + 1);
    for (int i = 0; i < count; ++i) cells_[i].push_back(trimmed(OGR_F_GetFieldAsString(feature.get(), i)));
  }
  if (lines_.empty())
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}: no rows, allowed: a header line with column names and at least one row", file.string()));
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
