"""The numbers that some laws take beside young and nu, and which of them are admissible."""

import numpy as np

from ..failure import BadInput, brief

__all__ = ["law_numbers", "refuse_numbers"]

# How many numbers a law takes, and what they are; other laws take none.
TAKEN: dict[str, tuple[tuple[int, ...], str]] = {
    "mooney-rivlin": (
        (1,),
        "1, the share of the second invariant in the shear modulus, 0 to 1",
    ),
    "ogden": (
        (2, 4, 6),
        "one to three exponents, each with its share of the shear modulus behind it",
    ),
}


def law_numbers(text: str) -> np.ndarray:
    """The numbers of a law, which are separated by commas, or none."""
    return np.array([float(word) for word in text.split(",") if text != "none"], dtype=float)


def refuse_numbers(entry: str, law: str, text: str, nu: float) -> None:
    """Raises BadInput unless the law can take the numbers `text` of the entry."""
    numbers = law_numbers(text)
    counts, words = TAKEN.get(law, ((0,), "none"))
    if len(numbers) not in counts:
        raise BadInput(f"{entry}: '{brief(text)}' is not what {law} takes (accepted: {words})")
    fault = ""
    if law == "mooney-rivlin":
        fault = _mooney_rivlin_fault(numbers[0], nu)
    if law == "ogden":
        fault = _ogden_fault(numbers[::2], numbers[1::2])
    if fault:
        raise BadInput(f"{entry}: {law} has {fault}")


def _mooney_rivlin_fault(share: float, nu: float) -> str:
    if not 0 <= share <= 1:
        return f"share {share:g} (accepted: 0 to 1)"
    limit = nu / (1 - 2 * nu) if nu < 0.5 else np.inf  # lambda / (2 mu)
    if share > limit:
        return (
            f"share {share:g} with a Poisson's ratio that is too small "
            f"(accepted: to lambda/(2 mu), {limit:g})"
        )
    return ""


def _ogden_fault(exponents: np.ndarray, shares: np.ndarray) -> str:
    for exponent, share in zip(exponents, shares):
        if exponent == 0 or abs(exponent) > 30 or share <= 0:
            return (
                f"the exponent {exponent:g} with share {share:g} "
                f"(accepted: -30 to 30, not 0, with a share above 0)"
            )
    if abs(shares.sum() - 1) > 1e-9:
        return f"shares that add up to {shares.sum():g} (accepted: an exponent and its share a term, sum 1)"
    return ""
