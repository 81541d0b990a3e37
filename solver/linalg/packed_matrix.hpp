// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <cstring>

#include "solver/assembly/pack.hpp"

namespace esfem {

/// pack_size complex numbers.
struct ComplexPack {
  Pack re, im;
};

inline void subtract_product(Pack& sum, const Pack& a, double b) {
  sum -= a * b;
}
inline void subtract_product(ComplexPack& sum, const ComplexPack& a, const std::complex<double>& b) {
  sum.re -= a.re * b.real();
  sum.im -= a.re * b.imag();
  sum.re += a.im * b.imag();
  sum.im -= a.im * b.real();
}
inline void subtract_product(Pack& sum, const Pack& a, const Pack& b) {
  sum -= a * b;
}
inline void subtract_product(ComplexPack& sum, const ComplexPack& a, const ComplexPack& b) {
  sum.re -= a.re * b.re;
  sum.im -= a.re * b.im;
  sum.re += a.im * b.im;
  sum.im -= a.im * b.re;
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
/// Four real numbers, or four complex ones: those of a row of right-hand sides.
using FourDoubles = double __attribute__((vector_size(4 * sizeof(double))));
struct FourComplex {
  FourDoubles re, im;
};
inline void subtract_product(FourDoubles& sum, const FourDoubles& a, double b) {
  sum -= a * b;
}
inline void subtract_product(FourComplex& sum, const FourComplex& a, const std::complex<double>& b) {
  sum.re -= a.re * b.real();
  sum.im -= a.re * b.imag();
  sum.re += a.im * b.imag();
  sum.im -= a.im * b.real();
}
inline double lane(const FourDoubles& row, int i) {
  return row[i];
}
inline std::complex<double> lane(const FourComplex& row, int i) {
  return {row.re[i], row.im[i]};
}
inline void set_lane(FourDoubles& row, int i, double value) {
  row[i] = value;
}
inline void set_lane(FourComplex& row, int i, const std::complex<double>& value) {
  row.re[i] = value.real();
  row.im[i] = value.imag();
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

/// A dense matrix whose columns are read and written in Packs; it refers to memory of somebody else. Rows are
/// numbered from `first_row`, a multiple of pack_size; `stride`, also one, is the number of rows that a
/// column has room for. Complex columns are all real parts, then all imaginary parts.
template <class T>
struct PackedMatrix;

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
  using FourNumbers = FourComplex;
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

}  // namespace esfem
