# SPDX-License-Identifier: GPL-3.0-or-later
"""What the report shows, and in which order: papers, their figures, and what this project adds."""
from collections import namedtuple

Paper = namedtuple("Paper", "key name authors title journal about figures")
Figure = namedtuple("Figure", "name number stem caption")  # name: figures/<name>.png; number: of the paper

PAPERS = (
    Paper("kll19", "Mean curvature flow", "B. Kovács, B. Li, Ch. Lubich",
          "A convergent evolving finite element algorithm for mean curvature flow of closed surfaces",
          "Numer. Math. 143 (2019)",
          "Mean curvature flow by evolution equations for normal and mean curvature, (5.1), compared with Dziuk's scheme (3.6).",
          (Figure("kll19/fig13_1", "13.1", "mcf_sphere", "Shrinking sphere: errors over the step size."),
           Figure("kll19/fig13_2", "13.2", "mcf_sphere", "Shrinking sphere: errors over the mesh width."),
           Figure("kll19/fig13_3", "13.3", "mcf_dumbbell", "The dumbbell by three methods, with the paper's starting procedure."),
           Figure("kll19/fig13_3_good_start", "13.3", "mcf_dumbbell",
                  "The same with accurate starting values, not in the paper."),
           Figure("kll19/fig13_4", "13.4", "mcf_dumbbell", "(5.1) with normalised normal close to the pinch."),
           Figure("kll19/fig13_5", "13.5", "mcf_dumbbell", "Largest mean curvature over time, its blow-up, and the smallest angle of the mesh."),
           Figure("kll19/fig13_6", "13.6", "mcf_dumbbell", "Least and largest length of the computed normal over time."))),
    Paper("nick18", "Surface evolution coupled to diffusion", "J. Nick",
          "Linearly implicit full discretization of surface evolution coupled to diffusion on the surface",
          "Master's thesis, Tübingen 2018",
          "Surface evolution coupled to diffusion on the surface, (2.19)–(2.21), and its variant (7.2).",
          (Figure("nick18/fig1", "1", "coupled_diffusion", "Errors of the position over the step size."),
           Figure("nick18/fig2", "2", "coupled_diffusion", "Errors of the position over the mesh width."),
           Figure("nick18/fig3", "3", "coupled_diffusion", "Errors of u over the step size."),
           Figure("nick18/fig4", "4", "coupled_diffusion", "Errors of u over the mesh width."),
           Figure("nick18/fig5", "5", "coupled_diffusion", "The difference between the two variants."))),
    Paper("kll21", "Willmore flow and surface diffusion", "B. Kovács, B. Li, Ch. Lubich",
          "A convergent evolving finite element algorithm for Willmore flow of closed surfaces", "Numer. Math. 149 (2021)",
          "Willmore flow and surface diffusion by evolution equations for normal and mean curvature, (3.4)–(3.5).",
          (Figure("kll21/fig7_1", "7.1", "willmore_sphere", "Sphere, no projections: errors and energy over the mesh width."),
           Figure("kll21/fig7_2", "7.2", "willmore_sphere", "Effect of the projections on the normal and on the sphere."),
           Figure("kll21/fig7_3", "7.3", "willmore_sphere", "Sphere with projections: errors and energy over the mesh width."),
           Figure("kll21/fig7_4", "7.4", "willmore_clifford_torus", "Clifford torus: errors and energy over the mesh width."),
           Figure("gallery/clifford_torus_graded", "7.4", "willmore_clifford_torus", "The same on unstructured graded meshes."),
           Figure("gallery/clifford_torus_stability", "7.4", "willmore_clifford_torus",
                  "Stability over the step size, with F implicit and extrapolated."),
           Figure("kll21/fig7_5", "7.5", "willmore_relaxation", "Three surfaces on their way to a sphere or a Clifford torus."),
           Figure("gallery/willmore_relaxation", "7.5", "willmore_relaxation",
                  "Distance of the energy from its limit: the paper's step size, adaptive steps, and relaxation."))),
    Paper("bk22", "Cahn–Hilliard equations", "C. A. Beschle, B. Kovács",
          "Stability and error estimates for non-linear Cahn–Hilliard-type equations on evolving surfaces",
          "Numer. Math. 151 (2022)",
          "Cahn–Hilliard equations on a surface with given motion, (8.3), with initial values (3.13).",
          (Figure("bk22/fig2", "2", "cahn_hilliard_ellipsoid", "BDF1: errors over the mesh width, in the paper's setting and from Ritz maps with ϑ."),
           Figure("bk22/fig3", "3", "cahn_hilliard_ellipsoid", "BDF1: the same over the step size."),
           Figure("bk22/fig4", "4", "cahn_hilliard_ellipsoid", "BDF3: errors over the mesh width, in the paper's setting and from Ritz maps with ϑ."),
           Figure("bk22/fig5", "5", "cahn_hilliard_ellipsoid", "BDF3: the same over the step size."),
           Figure("bk22/fig6", "6", "cahn_hilliard_energy", "Ginzburg–Landau energy on eight meshes."),
           Figure("bk22/fig7", "7", "cahn_hilliard_energy", "The same over a longer time."),
           Figure("bk22/fig8", "8", "cahn_hilliard_initial_values", "Solutions from interpolated initial values, and from Ritz maps with ϑ."))),
)

BEYOND = (
    Figure("gallery/all_orders", "", "all_orders", "Orders of all degrees and all BDF methods, for each flow."),
    Figure("gallery/mcf_angenent_torus", "", "mcf_angenent_torus",
           "Mean curvature flow of the self-shrinking torus: an exact solution that is not a sphere."),
    Figure("gallery/mcf_angenent_torus_time", "", "mcf_angenent_torus", "The same: errors in time of BDF1 to BDF5."),
    Figure("gallery/mcf_competitors", "", "mcf_competitors", "Mean curvature flow by three schemes: error against time."),
    Figure("gallery/willmore_projection", "", "willmore_projection",
           "Willmore flow without projections, with the paper's, and with projections in the coefficients: errors over the step size."),
    Figure("gallery/willmore_projection_length", "", "willmore_projection", "The same: the length of the computed normal on spheres."),
    Figure("gallery/willmore_competitors", "", "willmore_competitors", "Willmore flow by three schemes."),
    Figure("gallery/surface_diffusion", "", "surface_diffusion", "Surface diffusion of an ellipsoid."),
    Figure("gallery/helfrich_energies", "", "helfrich_vesicles", "Vesicles: energies of Helfrich flow with given area and volume."),
    Figure("gallery/helfrich_vesicles", "", "helfrich_vesicles", "The same: their shapes."),
    Figure("gallery/tumour_growth", "", "tumour_growth", "A growing tumour: surface evolution coupled to reaction and diffusion."),
    Figure("pfhub/fig1d", "", "cahn_hilliard_pfhub", "PFHub benchmark 1d: Cahn–Hilliard on a sphere."),
)

SYMBOLS = {"nu": "ν", "tau": "τ", "pi": "π", "epsilon": "ε", "theta": "ϑ", "alpha": "α", "beta": "β", "gamma": "γ",
           "lambda": "λ", "Gamma": "Γ", "Delta": "Δ", "kappa": "κ", "infinity": "∞", "grad": "∇", "sigma": "σ", "delta": "δ"}
