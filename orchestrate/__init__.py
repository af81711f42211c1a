"""Python side of ffimpact: scenes as data, meshes, one FreeFem++ process a run, figures, reports."""
