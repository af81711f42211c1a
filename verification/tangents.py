"""Laws and mesh sizes of the tests of tangents."""

COARSE = {"disc": {"accuracy": 0.1}, "ball": {"accuracy": 0.1}, "3d": {"mesh_size": 0.025, "contact_mesh_size": 0.015}}
MOONEY = {"law": "mooney-rivlin", "law_parameters": "0.3"}
OGDEN = {"law": "ogden", "law_parameters": "1.3,0.5,5,0.2,-2,0.3"}
