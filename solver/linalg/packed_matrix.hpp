// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <cstring>

#include "solver/pack.hpp"

namespace esfem {

/// @cond

/// As many complex numbers as Vector has real ones.
template <class Vector>
struct ComplexVector {
  Vector re, im;
};
using ComplexPack = ComplexVector<Pack>;

/// Those of a row of right-hand sides.
using FourDoubles = double __attribute__((vector_size(4 * sizeof(double))));

// sum -= a b, where b is one number or as many as a.
template <class Vector>
void subtract_product(Vector& sum, const Vector& a, double b) {
  sum -= a * b;
}
template <class Vector>
void subtract_product(Vector& sum, const Vector& a, const Vector& b) {
  sum -= a * b;
}
template <class Vector, class Number>
void subtract_complex_product(ComplexVector<Vector>& sum, const ComplexVector<Vector>& a, const Number& re,
                              const Number& im) {
  sum.re -= a.re * re;
  sum.im -= a.re * im;
  sum.re += a.im * im;
  sum.im -= a.im * re;
}
template <class Vector>
void subtract_product(ComplexVector<Vector>& sum, const ComplexVector<Vector>& a,
                      const std::complex<double>& b) {
  subtract_complex_product(sum, a, b.real(), b.imag());
}
template <class Vector>
void subtract_product(ComplexVector<Vector>& sum, const ComplexVector<Vector>& a,
                      const ComplexVector<Vector>& b) {
  subtract_complex_product(sum, a, b.re, b.im);
}

inline Pack sum_of(const Pack& a, const Pack& b) {
  return a + b;
}
inline ComplexPack sum_of(const ComplexPack& a, const ComplexPack& b) {
  return {a.re + b.re, a.im + b.im};
}
inline Pack product(const Pack& a, double b) {
  return a * b;
}
inline ComplexPack product(const ComplexPack& a, const std::complex<double>& b) {
  return {a.re * b.real() - a.im * b.imag(), a.re * b.imag() + a.im * b.real()};
}

inline double lane(const FourDoubles& numbers, int i) {
  return numbers[i];
}
inline std::complex<double> lane(const ComplexVector<FourDoubles>& numbers, int i) {
  return {numbers.re[i], numbers.im[i]};
}
inline void set_lane(FourDoubles& numbers, int i, double value) {
  numbers[i] = value;
}
inline void set_lane(ComplexVector<FourDoubles>& numbers, int i, const std::complex<double>& value) {
  numbers.re[i] = value.real();
  numbers.im[i] = value.imag();
}

/// Without the case distinctions of infinite numbers that C++'s operator makes.
inline std::complex<double> product(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
inline double product(double a, double b) {
  return a * b;
}
inline double lane_sum(const Pack& p) {
  return Eigen::Map<const Eigen::Array<double, pack_size, 1>, Eigen::Aligned64>(
             reinterpret_cast<const double*>(&p))
      .sum();
}
inline std::complex<double> lane_sum(const ComplexPack& p) {
  return {lane_sum(p.re), lane_sum(p.im)};
}

/// @endcond

/// A dense matrix whose columns are read and written in Packs; it does not own its memory. Rows are
/// numbered from `first_row`, a multiple of pack_size; `stride`, also one, is the number of rows that a
/// column has room for. Complex columns are all real parts, then all imaginary parts.
template <class T>
struct PackedMatrix;

/// @cond

template <>
struct PackedMatrix<double> {
  using Packed = Pack;
  using FourNumbers = FourDoubles;
  static constexpr int planes = 1;
  double* data;
  int stride, first_row;

  double* column(int j) const { return data + std::ptrdiff_t{j} * stride - first_row; }
  double get(int i, int j) const { return column(j)[i]; }
  void set(int i, int j, double value) const { column(j)[i] = value; }
  void add(int i, int j, double value) const { column(j)[i] += value; }
  /// `place` doubles from the beginning.
  void add_at(std::ptrdiff_t place, double value) const { data[place] += value; }
  Pack load(int i, int j) const { return load(column(j) + i, stride); }
  void store(int i, int j, const Pack& p) const { store(column(j) + i, stride, p); }

  /// The number whose real part is there; the imaginary part is a stride further.
  static double scalar(const double* from, int) { return *from; }
  static Pack load(const double* from, int) {
    Pack p;
    std::memcpy(&p, from, sizeof p);
    return p;
  }
  static void store(double* to, int, const Pack& p) { std::memcpy(to, &p, sizeof p); }
};

template <>
struct PackedMatrix<std::complex<double>> {
  using Packed = ComplexPack;
  using FourNumbers = ComplexVector<FourDoubles>;
  static constexpr int planes = 2;
  double* data;
  int stride, first_row;

  double* column(int j) const { return data + 2 * std::ptrdiff_t{j} * stride - first_row; }
  std::complex<double> get(int i, int j) const { return {column(j)[i], column(j)[i + stride]}; }
  void set(int i, int j, const std::complex<double>& value) const {
    column(j)[i] = value.real();
    column(j)[i + stride] = value.imag();
  }
  void add(int i, int j, const std::complex<double>& value) const {
    column(j)[i] += value.real();
    column(j)[i + stride] += value.imag();
  }
  void add_at(std::ptrdiff_t place, const std::complex<double>& value) const {
    data[place] += value.real();
    data[place + stride] += value.imag();
  }
  ComplexPack load(int i, int j) const { return load(column(j) + i, stride); }
  void store(int i, int j, const ComplexPack& p) const { store(column(j) + i, stride, p); }

  static std::complex<double> scalar(const double* from, int stride) { return {*from, from[stride]}; }
  static ComplexPack load(const double* from, int stride) {
    ComplexPack p;
    std::memcpy(&p.re, from, sizeof p.re);
    std::memcpy(&p.im, from + stride, sizeof p.im);
    return p;
  }
  static void store(double* to, int stride, const ComplexPack& p) {
    std::memcpy(to, &p.re, sizeof p.re);
    std::memcpy(to + stride, &p.im, sizeof p.im);
  }
};

/// The same numbers rounded to single precision, read as doubles.
struct RoundedMatrix {
  const float* data;
  int stride;

  const float* column(int j) const { return data + std::ptrdiff_t{j} * stride; }
  double get(int i, int j) const { return column(j)[i]; }
  Pack load(int i, int j) const {
    float __attribute__((vector_size(pack_size * sizeof(float)))) rounded;
    std::memcpy(&rounded, column(j) + i, sizeof rounded);
    return __builtin_convertvector(rounded, Pack);
  }
};

/// @endcond

}  // namespace esfem
