#include "app/hdf5_table.hpp"

#include <algorithm>
#include <cstring>

#include <hdf5.h>
#include <hdf5_hl.h>

namespace torsion::engine {
namespace {

constexpr std::size_t kRowsAtOnce = 1024;  // a chunk of the file

/// What the library says goes into an Error, not to stderr.
void be_quiet() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

struct Hdf5Table::Data {
  std::filesystem::path place;
  std::string name;
  std::vector<TableColumn> columns;
  std::vector<std::size_t> offsets;  // (columns) bytes
  std::vector<std::size_t> sizes;    // (columns) bytes
  std::size_t row_size = 0;          // bytes
  std::vector<std::byte> rows;       // that are not in the file yet
  hid_t file = H5I_INVALID_HID;
  bool failed = false;

  ~Data() { close(); }
  Data() = default;
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;
  Data(Data&&) = delete;
  Data& operator=(Data&&) = delete;

  void close() {
    if (file != H5I_INVALID_HID) {
      failed = H5Fclose(file) < 0 || failed;
      file = H5I_INVALID_HID;
    }
  }

  void write_rows() {
    const std::size_t count = rows.size() / row_size;
    if (count > 0 && !failed) {
      failed = H5TBappend_records(file, name.c_str(), count, row_size, offsets.data(), sizes.data(),
                                  rows.data()) < 0;
    }
    rows.clear();
  }

  [[nodiscard]] Error problem() const {
    return Error{place.string() + ": cannot be written as HDF5; is the disk full?"};
  }
};

Hdf5Table::Hdf5Table(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Hdf5Table::Hdf5Table(Hdf5Table&&) noexcept = default;
Hdf5Table& Hdf5Table::operator=(Hdf5Table&&) noexcept = default;
Hdf5Table::~Hdf5Table() = default;

Result<Hdf5Table> Hdf5Table::create(const std::filesystem::path& place, const std::string& name,
                                    std::span<const TableColumn> columns) {
  be_quiet();
  auto data = std::make_unique<Data>();
  data->place = place;
  data->name = name;
  data->columns.assign(columns.begin(), columns.end());
  std::vector<const char*> names;
  std::vector<hid_t> types;
  std::vector<hid_t> made;
  for (const TableColumn& column : data->columns) {
    const std::size_t size = column.text_size > 0 ? column.text_size : sizeof(double);
    names.push_back(column.name.c_str());
    types.push_back(H5T_NATIVE_DOUBLE);
    if (column.text_size > 0) {
      types.back() = H5Tcopy(H5T_C_S1);
      made.push_back(types.back());
      data->failed = H5Tset_size(types.back(), size) < 0 || data->failed;
    }
    data->offsets.push_back(data->row_size);
    data->sizes.push_back(size);
    data->row_size += size;
  }
  data->file = H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  data->failed =
      data->failed || data->file < 0 ||
      H5TBmake_table(name.c_str(), data->file, name.c_str(), names.size(), 0, data->row_size,
                     names.data(), data->offsets.data(), types.data(), kRowsAtOnce, nullptr,
                     /*compressed*/ 1, nullptr) < 0;
  for (const hid_t type : made) {
    H5Tclose(type);
  }
  if (data->failed) {
    return data->problem();
  }
  data->rows.reserve(kRowsAtOnce * data->row_size);
  return Hdf5Table(std::move(data));
}

void Hdf5Table::append(std::span<const double> numbers, std::span<const std::string> texts) {
  const std::size_t first = data_->rows.size();
  data_->rows.resize(first + data_->row_size);
  std::size_t number = 0;
  std::size_t text = 0;
  for (std::size_t k = 0; k < data_->columns.size(); ++k) {
    std::byte* const at = data_->rows.data() + first + data_->offsets[k];
    if (data_->columns[k].text_size == 0) {
      std::memcpy(at, &numbers[number++], sizeof(double));
    } else {
      const std::string& value = texts[text++];
      std::memcpy(at, value.data(), std::min(value.size(), data_->sizes[k]));
    }
  }
  if (data_->rows.size() >= kRowsAtOnce * data_->row_size) {
    data_->write_rows();
  }
}

Result<Done> Hdf5Table::finish() {
  data_->write_rows();
  data_->close();
  return data_->failed ? Result<Done>(data_->problem()) : Done{};
}

}  // namespace torsion::engine
