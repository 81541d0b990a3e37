// gmsh prism.geo -3 -format msh22 -o prisms.msh
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 1};
Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; }
Mesh.MeshSizeMax = 1.5;
