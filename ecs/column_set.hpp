#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ecs/state.hpp"

namespace torsion::engine {
namespace detail {

template <class AnyTable>
struct ColumnTypes;
template <class... Ts>
struct ColumnTypes<Table<Ts...>> {
  using Tuple = std::tuple<std::type_identity<Ts>...>;
};

template <class... Tables>
auto all_columns(std::tuple<Tables...>) -> decltype(std::tuple_cat(
    std::declval<typename ColumnTypes<std::remove_cvref_t<Tables>>::Tuple>()...));

/// A tuple of type_identity: the columns of all of State's tables, in order.
using StateColumns = decltype(all_columns(std::declval<const State&>().tables()));

/// A type's name without its namespaces, cut out of a function's. GCC and clang.
template <class T>
consteval std::string_view name_of() {
  constexpr std::string_view kFunction = __PRETTY_FUNCTION__;
  constexpr std::string_view kMark = "T = ";
  constexpr std::size_t kFirst = kFunction.find(kMark) + kMark.size();
  constexpr std::string_view kName =
      kFunction.substr(kFirst, kFunction.find_first_of(";]", kFirst) - kFirst);
  constexpr std::size_t kNamespace = kName.rfind("::", kName.find('<'));
  return kNamespace == std::string_view::npos ? kName : kName.substr(kNamespace + 2);
}

}  // namespace detail

inline constexpr std::size_t kStateColumns = std::tuple_size_v<detail::StateColumns>;

/// Some of the columns of State's tables.
struct ColumnSet {
  std::uint64_t bits = 0;  // bit i: the i-th column in the order of State::tables()

  [[nodiscard]] constexpr bool has(std::size_t column) const { return (bits >> column & 1U) != 0; }
  [[nodiscard]] constexpr bool empty() const { return bits == 0; }
  friend constexpr ColumnSet operator|(ColumnSet a, ColumnSet b) { return {a.bits | b.bits}; }
  friend constexpr ColumnSet operator&(ColumnSet a, ColumnSet b) { return {a.bits & b.bits}; }
  /// Those of `a` that `b` has not.
  friend constexpr ColumnSet operator-(ColumnSet a, ColumnSet b) { return {a.bits & ~b.bits}; }
  friend constexpr bool operator==(ColumnSet, ColumnSet) = default;
};
static_assert(kStateColumns <= 64);

/// A column's place in the order of State::tables().
template <class Wanted>
consteval std::size_t column_number() {
  return []<class... All>(std::type_identity<std::tuple<std::type_identity<All>...>>) {
    static_assert((std::is_same_v<All, Wanted> || ...), "no table of State has that column");
    const bool is_it[] = {std::is_same_v<All, Wanted>...};
    return static_cast<std::size_t>(std::ranges::find(is_it, true) - std::begin(is_it));
  }(std::type_identity<detail::StateColumns>{});
}

/// Of those types.
template <class... Columns>
consteval ColumnSet columns() {
  return {((std::uint64_t{1} << column_number<Columns>()) | ... | 0U)};
}

/// All columns of a table type.
template <class AnyTable>
consteval ColumnSet table_columns() {
  return []<class... Ts>(std::type_identity<std::tuple<std::type_identity<Ts>...>>) {
    return columns<Ts...>();
  }(std::type_identity<typename detail::ColumnTypes<AnyTable>::Tuple>{});
}

/// Their types' names, by number.
inline constexpr std::array<std::string_view, kStateColumns> kColumnNames =
    []<class... All>(std::type_identity<std::tuple<std::type_identity<All>...>>) {
      return std::array<std::string_view, kStateColumns>{detail::name_of<All>()...};
    }(std::type_identity<detail::StateColumns>{});

}  // namespace torsion::engine
