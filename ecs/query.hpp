#pragma once

#include <tuple>
#include <type_traits>

namespace torsion {
namespace detail {

template <class... Cs, class AnyTable, class F>
void visit_table(AnyTable& table, F& f) {
  using Bare = std::remove_const_t<AnyTable>;
  if constexpr ((Bare::template has<Cs> && ...)) {
    f([&table]() {
      using C = Cs;
      if constexpr (std::is_const_v<C>) {
        return std::as_const(table).template column<std::remove_const_t<C>>();
      } else {
        static_assert(!std::is_const_v<AnyTable>, "ask a const world for const components");
        return table.template column<C>();
      }
    }()...);
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
