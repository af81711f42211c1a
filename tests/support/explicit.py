"""Helpers that the modules test_explicit.py share."""



EXPLICIT = {"integrator": "central-difference"}
OBLIQUE = dict(law="neohookean", nu=0.45, speed=12, angle=60, penalty=1e10, friction_static=0.7, friction_dynamic=0.5, slip_velocity=0.1,
               mesh_size=0.012, contact_mesh_size=0.003)
