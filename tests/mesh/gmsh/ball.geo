// tests/mesh/test_msh_surface.cpp reads the files beside this one. of_meshio.msh is of plots/convert_mesh.py, the others of
// Gmsh 4.8:
//   gmsh ball.geo -2 -order 1 -format msh22 -bin -o binary_2.2.msh
//   gmsh ball.geo -2 -order 1 -format msh41 -bin -o binary_4.1.msh
//   gmsh ball.geo -2 -order 3 -format msh22 -o order_3.msh
//   gmsh ball.geo -2 -order 4 -format msh41 -bin -o order_4.msh
//   gmsh ball.geo -2 -order 3 -format msh41 -setnumber Mesh.SecondOrderIncomplete 1 -o incomplete.msh
//   gmsh ball.geo -2 -format msh41 -setnumber Mesh.RecombineAll 1 -clscale 0.7 -o quadrangles.msh
//   gmsh ball.geo -2 -format msh41 -setnumber Mesh.SaveParametric 1 -o parametric.msh
//   gmsh ball.geo -3 -order 2 -format msh22 -bin -o volume_2.msh
//   gmsh ball.geo -3 -format msh41 -part 2 -setnumber Mesh.PartitionCreateTopology 1 -o partitions.msh
SetFactory("OpenCASCADE");
Sphere(1) = {0.1, 0.2, 0.3, 1};
Mesh.MeshSizeMax = 1.2;
Mesh.MeshSizeMin = 1.2;
