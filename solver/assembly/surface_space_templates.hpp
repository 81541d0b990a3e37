// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Integration of user formulas: the templates of SurfaceSpace.
#include "solver/assembly/surface_space.hpp"

namespace esfem {

template <int inputs>
PointData<inputs> SurfaceSpace::point_data(const Batch& batch, int q, const BatchPoint& geometry,
                                           const DualTangents& dual, const Pack (*u)[inputs + 1]) const {
  PointData<inputs> data;
  Pack x[3] = {}, value[inputs + 1] = {}, xi[inputs + 1] = {}, eta[inputs + 1] = {};
  const ElementBatches::Shape* shape = batches_.shapes(q);
  for (int a = 0; a < batches_.nodes(); ++a) {
    for (int i = 0; i < 3; ++i) x[i] += shape[a].value * batch.x[a][i];
    for (int c = 0; c < inputs; ++c) {
      value[c] += shape[a].value * u[a][c];
      xi[c] += shape[a].dxi * u[a][c];
      eta[c] += shape[a].deta * u[a][c];
    }
  }
  for (int i = 0; i < 3; ++i) {
    data.x[i] = x[i];
    data.normal[i] = geometry.normal[i] * geometry.inverse_jacobian;
    for (int c = 0; c < inputs; ++c) data.grad[c][i] = xi[c] * dual.xi[i] + eta[c] * dual.eta[i];
  }
  for (int c = 0; c < inputs; ++c) data.u[c] = value[c];
  return data;
}

template <int inputs, int outputs, int fluxes, class Function>
void SurfaceSpace::assemble_load(const Field& x, const Field& u, const Function& integrand,
                                 Field& out) const {
  static_assert(fluxes <= outputs, "flux[l] belongs to output component l");
  require_rows(x, 3);
  require_rows(u, inputs);
  out.setZero(dofs(), outputs);
  Batch batch;
  BatchPoint geometry;
  Integrand<outputs, fluxes> at_point;
  Pack nodal[max_nodes_per_element][inputs + 1];
  Pack load[max_nodes_per_element][outputs];
  for (int b = 0; b < batches_.count(); ++b) {
    batches_.load(b, x, batch);
    batches_.gather(batch, u, inputs, nodal);
    for (int a = 0; a < batches_.nodes(); ++a)
      for (Pack& component : load[a]) component = Pack{};

    Lanes regular = ~Lanes{};
    for (int q = 0; q < batches_.points(); ++q) {
      regular &= batches_.evaluate(batch, q, geometry);
      const DualTangents dual(geometry);
      integrand(point_data<inputs>(batch, q, geometry, dual, nodal), at_point);
      const Pack weight = batches_.weight(q) * geometry.jacobian;
      Pack value[outputs], flux_xi[fluxes + 1], flux_eta[fluxes + 1];
      for (int l = 0; l < outputs; ++l) value[l] = weight * at_point.value[l];
      for (int l = 0; l < fluxes; ++l) {
        flux_xi[l] = weight * dot(at_point.flux[l], dual.xi);
        flux_eta[l] = weight * dot(at_point.flux[l], dual.eta);
      }
      const ElementBatches::Shape* shape = batches_.shapes(q);
      for (int a = 0; a < batches_.nodes(); ++a) {
        for (int l = 0; l < outputs; ++l) load[a][l] += shape[a].value * value[l];
        for (int l = 0; l < fluxes; ++l)
          load[a][l] += shape[a].dxi * flux_xi[l] + shape[a].deta * flux_eta[l];
      }
    }
    batches_.require_regular(regular, batch);
    for (int a = 0; a < batches_.nodes(); ++a)
      for (int l = 0; l < outputs; ++l)
        for (int lane = 0; lane < pack_size; ++lane)
          out(batch.node[pack_size * a + lane], l) += (load[a][l] * batch.one)[lane];
  }
}

template <int inputs, class Keep, class Add>
void SurfaceSpace::assemble_weighted(const Field& x, const Field& u, const Keep& keep, const Add& add) const {
  require_rows(x, 3);
  require_rows(u, inputs);
  Batch batch;
  BatchPoint geometry;
  Pack nodal[max_nodes_per_element][inputs + 1];
  for (int b = 0; b < batches_.count(); ++b) {
    batches_.load(b, x, batch);
    batches_.gather(batch, u, inputs, nodal);
    Lanes regular = ~Lanes{};
    for (int q = 0; q < batches_.points(); ++q) {
      regular &= batches_.evaluate(batch, q, geometry);
      keep(q, batch.one * batches_.weight(q),
           point_data<inputs>(batch, q, geometry, DualTangents(geometry), nodal), geometry);
    }
    batches_.require_regular(regular, batch);
    add(batch);
  }
}

template <int inputs, int outputs, class Weights>
void SurfaceSpace::assemble_weighted_masses(const Field& x, const Field& u, const Weights& weights,
                                            SymmetricMatrix (&out)[outputs]) const {
  for (SymmetricMatrix& matrix : out) {
    require_matrix(matrix);
    matrix.values.setZero();
  }
  const int points = batches_.points();
  if (int(mass_point_.size()) < outputs * points) mass_point_.resize(outputs * points);
  const auto keep = [&](int q, const Pack& rule, const PointData<inputs>& data, const BatchPoint& geometry) {
    Pack weight[outputs];
    weights(data, weight);
    const Pack area = rule * geometry.jacobian;
    for (int l = 0; l < outputs; ++l) mass_point_[l * points + q] = area * weight[l];
  };
  assemble_weighted<inputs>(x, u, keep, [&](const Batch& batch) {
    for (int l = 0; l < outputs; ++l) add_mass(batch, &mass_point_[l * points], out[l]);
  });
}

template <int inputs, class Weight>
void SurfaceSpace::assemble_weighted_mass(const Field& x, const Field& u, const Weight& weight,
                                          SymmetricMatrix& out) const {
  require_matrix(out);
  out.values.setZero();
  const auto keep = [&](int q, const Pack& rule, const PointData<inputs>& data, const BatchPoint& geometry) {
    mass_point_[q] = rule * geometry.jacobian * weight(data);
  };
  assemble_weighted<inputs>(x, u, keep,
                            [&](const Batch& batch) { add_mass(batch, mass_point_.data(), out); });
}

template <int inputs, class Weight>
void SurfaceSpace::assemble_weighted_stiffness(const Field& x, const Field& u, const Weight& weight,
                                               SymmetricMatrix& out) const {
  require_matrix(out);
  out.values.setZero();
  const auto keep = [&](int q, const Pack& rule, const PointData<inputs>& data, const BatchPoint& geometry) {
    set_stiffness_point(q, rule * weight(data), geometry);
  };
  assemble_weighted<inputs>(x, u, keep, [&](const Batch& batch) { add_stiffness(batch, out); });
}

}  // namespace esfem
