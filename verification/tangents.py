"""Laws and mesh sizes of the tests of tangents."""

COARSE = {"disc": {"accuracy": 0.1}, "ball": {"accuracy": 0.1}, "3d": {"mesh_size": 0.025, "contact_mesh_size": 0.015}}
METAL = {"law": "metal", "nu": 0.3, "yield_stress": 2e5, "hardening": 3e5}   # beside young = 7e6
MOONEY = {"law": "mooney-rivlin", "share": 0.3}
# shares 0.5, 0.2 and 0.3 of the shear modulus of young = 7e6 and nu = 0.45
OGDEN = {"law": "ogden", "alpha": (1.3, 5, -2), "mu": tuple(7e6 / 1.45 * share / alpha for share, alpha in ((0.5, 1.3), (0.2, 5), (0.3, -2)))}
# energies of invariants and of stretches whose terms do not separate; flags are hashable
EXPONENTIAL = {"law": "energy", "energy": "c*(I1-3) - 2*c*log(J) + d*(I2*J^(-4/3)-3) + a/b*(exp(b*(I1*J^(-2/3)-3)^2)-1) + k/4*(J^2-1-2*log(J))",
               "parameters": (("c", 8e5), ("d", 2e5), ("a", 1e4), ("b", 0.1), ("k", 1.6e7))}
MIXED = {"law": "energy", "energy": "m/p*(L1^p + L2^p + L3^p - 3 - p*log(J)) + d*(sqrt(L1*L2) + sqrt(L2*L3) + sqrt(L3*L1) - 3 - log(J)) + k/2*log(J)^2",
         "parameters": (("m", 1.2e6), ("p", 2.6), ("d", 2e6), ("k", 1.5e7))}
