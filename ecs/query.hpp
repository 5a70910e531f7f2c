#pragma once

#include <tuple>
#include <type_traits>
#include <utility>

namespace torsion {
namespace detail {

template <class C, class AnyTable>
auto column_of(AnyTable& table) {
  if constexpr (std::is_const_v<C>) {
    return std::as_const(table).template column<std::remove_const_t<C>>();
  } else {
    static_assert(!std::is_const_v<AnyTable>, "a const world has only const components");
    return table.template column<C>();
  }
}

template <class... Cs, class AnyTable, class F>
void visit_table(AnyTable& table, F& f) {
  if constexpr ((std::remove_const_t<AnyTable>::template kHas<Cs> && ...)) {
    f(column_of<Cs>(table)...);
  }
}

}  // namespace detail

/// Calls f(std::span<C>...) once for each table of `world.tables()` that has all the components Cs,
/// in the order of tables(); the spans have one length and row i of each belongs to the same thing.
/// `const C` reads only:
///
///   each<const Entity, OwnedRows>(world, [](std::span<const Entity> who, std::span<OwnedRows>
///   rows) { ... });
///
/// Resolved by the compiler: no lookup at run time. f must not add or remove rows (ecs/commands.hpp
/// does).
template <class... Cs, class AnyWorld, class F>
void each(AnyWorld& world, F&& f) {
  static_assert(sizeof...(Cs) > 0);
  std::apply([&f](auto&... tables) { (detail::visit_table<Cs...>(tables, f), ...); },
             world.tables());
}

}  // namespace torsion
