"""Laws and mesh sizes of the tests of tangents."""

COARSE = {"disc": {"accuracy": 0.1}, "ball": {"accuracy": 0.1}, "3d": {"mesh_size": 0.025, "contact_mesh_size": 0.015}}
METAL = {"law": "metal", "nu": 0.3, "yield_stress": 2e5, "hardening": 3e5}   # beside young = 7e6
MOONEY = {"law": "mooney-rivlin", "share": 0.3}
# shares 0.5, 0.2 and 0.3 of the shear modulus of young = 7e6 and nu = 0.45
OGDEN = {"law": "ogden", "alpha": (1.3, 5, -2), "mu": tuple(7e6 / 1.45 * share / alpha for share, alpha in ((0.5, 1.3), (0.2, 5), (0.3, -2)))}
