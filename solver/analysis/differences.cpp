// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/differences.hpp"

#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/closest_point.hpp"

namespace esfem {
namespace {

/// The values of a function, side by side for all fields, and their tangential gradients in points of it.
class Evaluation {
 public:
  Evaluation(const Mesh& mesh, const Field& values) : mesh_(mesh), values_(values), closest_(mesh) {}

  void at(const Vec3& x, Eigen::RowVectorXd& value, Eigen::MatrixXd& gradient) const {
    const ElementPoint point = closest_(x);
    const ShapeTable shapes = shape_functions(mesh_.degree, Eigen::RowVector2d(point.xi, point.eta));
    const Field nodes = mesh_.nodes(mesh_.elements.row(point.element), Eigen::all),
                u = values_(mesh_.elements.row(point.element), Eigen::all);
    Eigen::MatrixXd dX(2, 3), du(2, u.cols());
    dX << shapes.dxi * nodes, shapes.deta * nodes;
    du << shapes.dxi * u, shapes.deta * u;
    value = shapes.value * u;
    // grad u = DX G^-1 Du with the first fundamental form G.
    gradient = dX.transpose() * (dX * dX.transpose()).ldlt().solve(du);
  }

 private:
  const Mesh& mesh_;
  const Field& values_;
  ClosestPoint closest_;
};

}  // namespace

Errors differences(const DiscreteFunctions& coarse, const DiscreteFunctions& fine) {
  std::vector<ExactEvolution::Quantity> quantities = {{"x", 3}};
  Field mine = coarse.mesh.nodes, other = fine.mesh.nodes;
  const auto append = [](Field& all, const Field& values) {
    Field both(all.rows(), all.cols() + values.cols());
    both << all, values;
    all = std::move(both);
  };
  for (const NodalField& field : coarse.fields) {
    const Field* found = find(fine.fields, field.name);
    if (!found || found->cols() != field.values.cols())
      throw InputError(field.name + ": the finer solution has no such field of as many components");
    quantities.push_back({field.name, static_cast<int>(field.values.cols())});
    append(mine, field.values);
    append(other, *found);
  }
  const SurfaceSpace space(coarse.mesh);
  const Evaluation evaluation(fine.mesh, other);
  Eigen::RowVectorXd value;
  Eigen::MatrixXd gradient;
  ExactEvolution finer;
  finer.quantities = quantities;
  finer.fields = [&](double, const SurfacePoints& at, FieldsAtPoints& out) {
    for (int lane = 0; lane < pack_size; ++lane) {
      evaluation.at(lane_of(at.y, lane), value, gradient);
      for (int l = 0; l < value.size(); ++l) {
        const Vec3 in_space = gradient.col(l), normal = lane_of(at.normal, lane);
        const Vec3 tangential = in_space - in_space.dot(normal) * normal;
        out.value[l][lane] = value[l];
        for (int i = 0; i < 3; ++i) out.gradient[l][i][lane] = tangential[i];
      }
    }
  };
  Errors errors;
  raise_maxima({space, quantities}, "closest", unlifted_errors(space, coarse.mesh.nodes, finer, 0, mine),
               errors);
  return errors;
}

}  // namespace esfem
