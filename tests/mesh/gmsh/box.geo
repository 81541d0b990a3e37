// gmsh box.geo -3 -format msh41 -bin -o hexahedra.msh
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 2, 3};
Transfinite Curve{:} = 3;
Transfinite Surface{:};
Transfinite Volume{:};
Recombine Surface{:};
