"""Laws and mesh sizes of the tests of tangents, and the comparison of kernels and scripts."""

COARSE = {"disc": {"accuracy": 0.1}, "ball": {"accuracy": 0.1}, "3d": {"mesh_size": 0.025, "contact_mesh_size": 0.015}}
MOONEY = {"law": "mooney-rivlin", "law_parameters": "0.3"}
OGDEN = {"law": "ogden", "law_parameters": "1.3,0.5,5,0.2,-2,0.3"}


def kernels_are_the_scripts(numbers: dict) -> None:
    """Asserts that kernels and scripts agree to round-off in the numbers that kernels.idp prints, if
    there is a compiler: deformation, forces and tangent."""
    assert not numbers["built"] or max(numbers[name] for name in ("deformed", "forces", "product")) < 1e-12 and numbers["refused"] == 0
