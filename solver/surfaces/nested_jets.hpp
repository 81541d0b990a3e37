// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ceres/jet.h>

// Ceres defines the arithmetic of a Jet<T, N> with its scalar T. In a nested Jet the scalar is a Jet itself,
// so that "2.0 * x" would not compile; these overloads (found by argument-dependent lookup) add the doubles,
// at any depth. Quotients and square roots are here, too: those of Ceres say T(1.0), which needs a double.
namespace ceres {

/// Makes constants of a scalar type, at any depth of nesting.
template <class T>
struct FromDouble {
  /// c, with derivatives 0.
  static T make(double c) { return T(c); }
};
/// That of nested Jets.
template <class T, int N>
struct FromDouble<Jet<T, N>> {
  /// c, with derivatives 0.
  static Jet<T, N> make(double c) { return Jet<T, N>(FromDouble<T>::make(c)); }
};

template <class T, int N, int M>
Jet<Jet<T, N>, M> operator+(const Jet<Jet<T, N>, M>& f, double c) {
  return f + FromDouble<Jet<T, N>>::make(c);
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator+(double c, const Jet<Jet<T, N>, M>& f) {
  return f + c;
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator-(const Jet<Jet<T, N>, M>& f, double c) {
  return f + (-c);
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator-(double c, const Jet<Jet<T, N>, M>& f) {
  return -f + c;
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator*(const Jet<Jet<T, N>, M>& f, double c) {
  return f * FromDouble<Jet<T, N>>::make(c);
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator*(double c, const Jet<Jet<T, N>, M>& f) {
  return f * c;
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator/(const Jet<Jet<T, N>, M>& f, double c) {
  return f * (1.0 / c);
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator/(const Jet<Jet<T, N>, M>& f, const Jet<Jet<T, N>, M>& g) {
  const Jet<T, N> inverse = 1.0 / g.a;
  const Jet<T, N> quotient = f.a * inverse;
  Jet<Jet<T, N>, M> result(quotient);
  for (int i = 0; i < M; ++i) result.v[i] = (f.v[i] - quotient * g.v[i]) * inverse;
  return result;
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> operator/(double c, const Jet<Jet<T, N>, M>& f) {
  return FromDouble<Jet<Jet<T, N>, M>>::make(c) / f;
}
template <class T, int N, int M>
Jet<Jet<T, N>, M> sqrt(const Jet<Jet<T, N>, M>& f) {
  const Jet<T, N> root = sqrt(f.a);
  const Jet<T, N> slope = 0.5 / root;
  Jet<Jet<T, N>, M> result(root);
  for (int i = 0; i < M; ++i) result.v[i] = slope * f.v[i];
  return result;
}

}  // namespace ceres
