#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ecs/column.hpp"
#include "ecs/range.hpp"

namespace torsion::engine {

/// Parallel columns: row i of every column belongs to the same thing. Memory is taken once, by
/// `reserve`.
template <Component... Ts>
class Table {
 public:
  template <class T>
  static constexpr bool kHas = (std::is_same_v<std::remove_const_t<T>, Ts> || ...);

  Table() = default;
  /// A copy has memory for as many rows, and takes it.
  Table(const Table& other) { *this = other; }
  Table& operator=(const Table& other) {
    if (this != &other) {
      if (capacity_ != other.capacity_) {
        reserve(other.capacity_);
      }
      copy_rows(other);
    }
    return *this;
  }
  Table(Table&& other) noexcept { *this = std::move(other); }
  Table& operator=(Table&& other) noexcept {
    columns_ = std::move(other.columns_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }
  ~Table() = default;

  /// Takes memory for `capacity` rows in every column and empties the table. Only this and a copy
  /// allocate.
  void reserve(std::uint32_t capacity) {
    (std::get<Column<Ts>>(columns_).reserve(capacity), ...);
    capacity_ = capacity;
    size_ = 0;
  }

  /// Adds `count` zeroed rows at the end; nullopt, and no change, when they do not fit.
  std::optional<Range> append(std::uint32_t count = 1) {
    if (count > capacity_ - size_) {
      return std::nullopt;
    }
    const Range rows{size_, count};
    (clear_rows<Ts>(rows), ...);
    size_ += count;
    return rows;
  }

  /// Makes it so many rows, all zero. @pre count <= capacity()
  void assign_zeros(std::uint32_t count) {
    TORSION_ASSERT(count <= capacity_);
    size_ = count;
    zero({0, count});
  }

  /// Removes one row; the rows behind it move up, so order is kept.
  void erase(std::uint32_t row) {
    TORSION_ASSERT(row < size_);
    (shift_up<Ts>(row), ...);
    size_ -= 1;
  }

  /// Zeroes some rows, as append does.
  void zero(Range rows) {
    TORSION_ASSERT(rows.end() <= size_);
    (clear_rows<Ts>(rows), ...);
  }

  /// Empties the table and keeps its memory.
  void clear() { size_ = 0; }

  /// All rows of one column, ascending.
  template <class T>
  [[nodiscard]] std::span<T> column() {
    return {std::get<Column<T>>(columns_).data(), size_};
  }
  template <class T>
  [[nodiscard]] std::span<const T> column() const {
    return {std::get<Column<T>>(columns_).data(), size_};
  }

  /// The rows of `range` in one column.
  template <class T>
  [[nodiscard]] std::span<T> rows(Range range) {
    TORSION_ASSERT(range.end() <= size_);
    return column<T>().subspan(range.first, range.count);
  }
  template <class T>
  [[nodiscard]] std::span<const T> rows(Range range) const {
    TORSION_ASSERT(range.end() <= size_);
    return column<T>().subspan(range.first, range.count);
  }

  template <class T>
  [[nodiscard]] T& at(std::uint32_t row) {
    TORSION_ASSERT(row < size_);
    return std::get<Column<T>>(columns_).data()[row];
  }
  template <class T>
  [[nodiscard]] const T& at(std::uint32_t row) const {
    TORSION_ASSERT(row < size_);
    return std::get<Column<T>>(columns_).data()[row];
  }

  [[nodiscard]] std::uint32_t size() const { return size_; }
  [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  /// Calls f(bytes, row_size) for each column, in declaration order: for saving, hashing and
  /// uploading.
  template <class F>
  void each_column(F&& f) const {
    (f(std::as_bytes(column<Ts>()), sizeof(Ts)), ...);
  }
  template <class F>
  void each_column(F&& f) {
    (f(std::as_writable_bytes(column<Ts>()), sizeof(Ts)), ...);
  }

  /// Makes this table hold the same rows as `other`. @pre other.size() <= capacity()
  void copy_rows(const Table& other) {
    TORSION_ASSERT(other.size_ <= capacity_);
    size_ = other.size_;
    (copy_column<Ts>(other), ...);
  }

 private:
  template <class T>
  void clear_rows(Range range) {
    if (range.count > 0) {
      std::memset(static_cast<void*>(std::get<Column<T>>(columns_).data() + range.first), 0,
                  range.count * sizeof(T));
    }
  }

  template <class T>
  void copy_column(const Table& other) {
    if (size_ > 0) {
      std::memcpy(static_cast<void*>(std::get<Column<T>>(columns_).data()),
                  std::get<Column<T>>(other.columns_).data(), size_ * sizeof(T));
    }
  }

  template <class T>
  void shift_up(std::uint32_t row) {
    T* const data = std::get<Column<T>>(columns_).data();
    std::memmove(static_cast<void*>(data + row), data + row + 1, (size_ - row - 1) * sizeof(T));
  }

  std::tuple<Column<Ts>...> columns_;
  std::uint32_t size_ = 0;
  std::uint32_t capacity_ = 0;
};

}  // namespace torsion::engine
