// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/features.hpp"

namespace esfem {

/// A smooth surface through the corners of a closed flat triangulation, sharp edges kept: at every corner, in
/// each sector between sharp edges, a polynomial of degree k + 2 over the tangent plane is fitted to the
/// corners around (Cazals & Pouget, CAGD 22, 2005), and in a triangle the three surfaces are blended by
/// barycentric coordinates. Along sharp edges it is a curve through the corners of the feature, a straight
/// line where the feature has corners at both ends.
///
/// The interpolant of a surface by P_k elements has errors O(h^(k+1)) in position, O(h^k) in normals, and
/// O(h^(k-1)) in H, which is a derivative of the normal. Nodes that are off by d add d/h to the normals and
/// d/h² to H. So with straight edges, d = O(h²), H does not converge, and d = O(h^(k+1)) would suffice. The
/// fits have d = O(h^(k+3)), the best that two rings of corners allow for k = 2, so that the errors are soon
/// those of the interpolant.
class SmoothSurface {
 public:
  /// For elements of degree k = 2, 3, 4. `flat` is of degree 1 and must outlive the object. Throws InputError
  /// unless it is closed, and for another k or angle.
  SmoothSurface(const Mesh& flat, int degree, double feature_angle);

  /// The point over a point of a flat element with barycentric coordinates `weights`. Where the fits
  /// oscillate (further away than a quarter of the longest edge), it is the flat point itself, and is_wild is
  /// set.
  Vec3 point(int element, const Vec3& weights, bool& is_wild) const;
  /// The same without is_wild.
  Vec3 point(int element, const Vec3& weights) const;

  /// The sharp edges and sectors of `flat`.
  const Features& features() const { return features_; }

 private:
  /// A polynomial in u, v without constant term over a tangent plane: w = r sum c_ij (u/r)^i (v/r)^j.
  struct Height {
    Vec3 origin;
    Mat3 frame;  ///< columns: two tangents and the normal
    double radius = 1;
    int degree = 1;
    Eigen::VectorXd coefficients;
  };
  struct Level {
    double value;
    Vec3 gradient;
  };

  std::vector<Vec3> sector_normals() const;
  void fit(int sector, int degree, const std::vector<Vec3>& normals,
           const std::vector<std::vector<int>>& neighbours);
  static Level distance(const Height& height, const Vec3& x);
  Vec3 blended_point(int element, const Vec3& weights, const Vec3& start) const;
  Vec3 feature_point(int side, double s) const;
  Vec3 corner(int element, int i) const { return flat_.nodes.row(flat_.elements(element, i % 3)); }

  const Mesh& flat_;
  Features features_;
  int along_feature_;  ///< corners on either side of a sharp edge that its curve goes through
  std::vector<int> node_of_sector_;
  std::vector<Height> heights_;  ///< one a sector
};

/// What curved_mesh makes of a flat triangulation.
struct CurvedMesh {
  Mesh mesh;         ///< of degree k; corners where they were
  int sharp_edges;   ///< edges whose triangles enclose more than the feature angle
  int edges;         ///< all of them, sharp or not
  int straight = 0;  ///< nodes left on the flat triangles: the surface is too rough, or folds there
};

/// The P_k mesh whose edge and face nodes lie on the smooth surface through the corners of a closed flat
/// triangulation. The Jacobian of every element is positive. Errors as of SmoothSurface.
CurvedMesh curved_mesh(const Mesh& flat, int degree, double feature_angle = default_feature_angle);

/// Whether every node of a mesh lies on straight edges and flat triangles.
bool is_flat(const Mesh& mesh);

}  // namespace esfem
