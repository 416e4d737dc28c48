// One visitor of a variant, out of a lambda for each alternative.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace umbrick {

/// Beside a handler of the rest (`const auto&`), a handler that takes a pointer takes exactly that type: a `double*`
/// fits the handler of the rest better than one of `const double*`.
///   std::visit(Overload{[](int) {...}, [](const auto&) {...}}, variant)
template <class... Handlers>
struct Overload : Handlers... {
  using Handlers::operator()...;
};
// Compilers before Clang 17 do not deduce the handlers of an aggregate by themselves.
template <class... Handlers>
Overload(Handlers...) -> Overload<Handlers...>;

}  // namespace umbrick
