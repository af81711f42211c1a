"""Alters the package in thirty places, one after the other, in a copy: signs, factors, units and
limits. Prints which alterations the tests without FreeFEM notice; at least LEAST must be. Run by
`make mutants`. ARGS="sizes.py filters" selects the alterations whose file or text has one of these
words, without a run of the tests before.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LEAST = 27
LONGEST = 900  # time limit of the tests of one alteration [s]; tests that hang have noticed it
# File of the package, text that stands in it once, and the text in its place.
ALTERATIONS = (
    ("geometry/outlines.py", "(1 / (3 + 3 * np.cos(turn)) - 1 / 6)", "(1 / (3 + 3 * np.cos(turn)) + 1 / 6)"),
    ("geometry/time_functions.py", "second = (3 * secant - 2", "second = (2 * secant - 2"),
    ("geometry/tumbling.py", "(1 - math.cos(angle)) * K @ K", "(1 + math.cos(angle)) * K @ K"),
    ("mesh/curved.py", "solution[3] + (solution[:3] ** 2)", "solution[3] - (solution[:3] ** 2)"),
    ("output/contacts.py", "self.jump = self.impulse / reduced", "self.jump = self.impulse * reduced"),
    ("output/contacts.py", "values *= 0.5", "values *= 1.0"),
    ("output/contacts.py", "> MIN_APPROACH_SHARE * jump and after.normal >= 0", "> MIN_APPROACH_SHARE * jump and after.normal <= 0"),
    ("output/contacts.py", "math.degrees(math.atan2(normal, along_surface))", "math.atan2(normal, along_surface)"),
    ("output/errors.py", 'estimates[name] = share["rebound"] * answers.speed', 'estimates[name] = share["rebound"] * answers.speed / 2'),
    ("output/estimate.py", "SAFETY[len(pairs)] / (ratio - 1)", "SAFETY[len(pairs)] / (ratio + 1)"),
    ("output/estimate.py", "factor**2 * accuracy", "factor * accuracy"),
    ("output/evaluate.py", "v[k] + (end - t[k]) * slope", "v[k] - (end - t[k]) * slope"),
    ("output/filters.py", "DESIGN = 2.0775", "DESIGN = 1 / 0.6"),
    ("output/modes.py", "np.sqrt(values[k]) / (2 * np.pi)", "np.sqrt(values[k])"),
    ("output/rest.py", "2 * apart / (1 - e**2)", "2 * apart / (1 + e**2)"),
    ("output/results.py", "(seen / 2 - common)", "(seen / 2 + common)"),
    ("output/warnings.py", "if drift > accuracy:", "if drift > 10 * accuracy:"),
    ("output/warnings.py", "float(penalty[largest] / elastic[largest])", "float(elastic[largest] / penalty[largest])"),
    ("report/contact.py", "3 * force / (2 * np.pi * a**2)", "3 * force / (np.pi * a**2)"),
    ("report/figures.py", "abs(slip) / (3 * pull)", "abs(slip) / (2 * pull)"),
    ("report/impact.py", "spin if vx >= 0 else -spin", "spin if vx >= 0 else spin"),
    ("report/impacts.py", "share * (1 - share) / 2, 0)", "share * (1 - share), 0)"),
    ("report/report.py", '"peak force", f"kN{per}", 1e-3', '"peak force", f"kN{per}", 1e3'),
    ("running/forecast.py", "(1 - at.share) / (at.share - since.share)", "1 / (at.share - since.share)"),
    ("scenes/approach.py", "arm[0] * n[1] - arm[1] * n[0]", "arm[0] * n[1] + arm[1] * n[0]"),
    ("input/materials.py", "math.sqrt(wave / self.density) / thickness", "math.sqrt(wave / self.density) / (2 * thickness)"),
    ("scenes/front.py", "min(self.tau / STEEPNESS, LONGEST", "max(self.tau / STEEPNESS, LONGEST"),
    ("scenes/sizes.py", "1.31 * share**0.4", "1.31 * share**0.2"),
    ("scenes/sizes.py", "0.01 * max(self._speed_along", "0.1 * max(self._speed_along"),
    ("sweeps/sweep_figures.py", "2 * np.hypot(errors[i], errors[j])", "np.hypot(errors[i], errors[j])"),
)


def passes(copy: Path, tests: list[Path]) -> bool:
    """Runs tests in the copy until the first fails. Returns whether all pass in time; also without tests."""
    if not tests:
        return True
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *map(str, tests)]
    environment = os.environ | {"PYTHONPATH": str(copy / "orchestrate")}
    try:
        return subprocess.run(command, cwd=copy, env=environment, capture_output=True, timeout=LONGEST).returncode == 0
    except subprocess.TimeoutExpired:
        return False


def notices(copy: Path, module: str) -> bool:
    """Whether a test fails. The files that import the module run first."""
    tests = sorted((copy / "tests/unit").glob("test_*.py"))
    folder, name = Path(module).with_suffix("").parts
    imports = re.compile(rf"(?m)^ *from ffimpact\.{folder}(\.{name}\b| import .*\b{name}\b)")
    near = [test for test in tests if imports.search(test.read_text())]
    return not (passes(copy, near) and passes(copy, [test for test in tests if test not in near]))


def main(words: list[str]) -> int:
    chosen = [alteration for alteration in ALTERATIONS if not words or any(word in text for word in words for text in alteration)]
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        for name in subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0"):
            if name and (ROOT / name).exists():
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, copy / name)
        if not words and not passes(copy, [copy / "tests/unit"]):
            sys.exit("mutants: the tests fail without an alteration")
        noticed = 0
        for module, old, new in chosen:
            path = copy / "orchestrate/ffimpact" / module
            text = path.read_text()
            if text.count(old) != 1:
                sys.exit(f"mutants: {module}: {old!r} stands in it {text.count(old)} times (accepted: once)")
            path.write_text(text.replace(old, new))
            seen = notices(copy, module)
            path.write_text(text)
            noticed += seen
            print(f"{'noticed' if seen else 'MISSED '}  {module}: {old}  ->  {new}", flush=True)
    print(f"noticed {noticed} of {len(chosen)}")
    return int(noticed < LEAST * len(chosen) / len(ALTERATIONS))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
