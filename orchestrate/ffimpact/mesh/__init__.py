"""Meshes of bodies: made with gmsh, read from files."""
