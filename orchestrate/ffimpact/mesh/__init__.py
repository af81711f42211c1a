"""Meshes of bodies: generated with gmsh or read from files."""
