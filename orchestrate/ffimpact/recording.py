"""From the sound of a bouncing ball to its restitution (docs/how-to/bounces.md). Units are SI.

drop = ff.bounces("drop.wav", mass=0.0415, radius=0.021)
drop.table
"""

from __future__ import annotations

import argparse
import math
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from . import flight, repeats
from .failure import BadInput, NotInstalled, Unreadable, brief

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Bounces", "Sound", "bounces", "heard", "main", "read_sound"]

Array = NDArray[np.float64]
WINDOW = 5e-4  # length of the windows of the loudness [s]
LOWEST = 300.0  # below this frequency [Hz] a recording is not used: wind, steps, hum
LOUD = 8.0  # a bounce over the noise, in amplitude
RISE = 3.0  # the onset of a bounce: where the loudness first exceeds this many times the noise
ECHO = 0.25  # share of the time since the bounce before within which louder sounds are its echo
CLIPPED = 1e-3  # share of samples at the ends of the range from which on a recording is clipped
FEWEST = 3  # bounces
EVEN = 0.2  # largest deviation of the logarithm of a restitution from the median of the others


@dataclass(frozen=True)
class Sound:
    """A recording: `samples` (n,) between -1 and 1 in steps of `quantum` at `rate` [1/s], and what is
    to be said of it.
    """

    samples: Array
    rate: float
    quantum: float = 0.0
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Bounces:
    """The bounces of a ball. `times` (n,) [s]: onsets of the contacts; `resolution` [s]: their
    standard error; `notes`: what was left out, and why.

    `table` has a row for each bounce between two flights: the speed before it [m/s], its
    restitution with drag and contact time in the flights, the standard error of both, and the
    ratio of the intervals alone.
    """

    times: Array
    resolution: float
    table: pd.DataFrame
    notes: tuple[str, ...] = ()
    sound: Sound | None = None

    @property
    def restitution(self) -> tuple[float, float]:
        """Median of the restitutions, and its standard error from their spread."""
        return repeats.middle(self.table["restitution"].dropna().to_numpy())

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws the loudness over time with the onsets, or the restitutions without a recording."""
        from .report.recording import draw

        return draw(self, ax)


def bounces(
    recording: str | Path | Sequence[float] | Array,
    *,
    mass: float | None = None,
    radius: float | None = None,
    contact_time: float = 0.0,
    gravity: float = flight.GRAVITY,
    air: float = flight.AIR,
) -> Bounces:
    """Returns the bounces of a ball that falls and bounces by itself.

    recording: a WAV file, another sound file if ffmpeg is installed, a CSV file with a column
    `time` [s], or the times of the bounces [s]. With mass [kg] and radius [m] the drag of the air
    (density `air` [kg/m3], coefficient 0.5) is taken into account; contact_time [s]: of each bounce,
    which is part of the interval behind it.

    A flight between two bounces lasts u/g up and v/g down but for drag; the restitution of a bounce
    is the speed behind it over that before it. Raises BadInput if there are too few bounces, Unreadable
    if there is no such file.
    """
    _check(mass, radius, contact_time, gravity, air)
    sound: Sound | None = None
    notes: list[str] = []
    if isinstance(recording, str | Path):
        path = Path(recording)
        if path.suffix.lower() == ".csv":
            times, resolution = _read_times(path), 0.0
        else:
            sound = read_sound(path)
            times, resolution, notes = heard(sound, str(path))
    else:
        times, resolution = np.asarray(recording, dtype=float), 0.0
    named = str(recording) if isinstance(recording, str | Path) else "times"
    if len(times) < FEWEST or not np.isfinite(times).all() or (np.diff(times) <= 0).any():
        raise BadInput(
            f"{named}: {len(times)} bounces (accepted: {FEWEST} or more, each later than the one before)"
        )
    drag = 0.0
    if mass is not None and radius is not None:
        drag = flight.drag_of(mass, radius, air)
    table, more = _restitutions(times, resolution, contact_time, gravity, drag)
    return Bounces(
        times, resolution, table, (*(sound.notes if sound else ()), *notes, *more), sound
    )


def _check(
    mass: float | None, radius: float | None, contact_time: float, gravity: float, air: float
) -> None:
    if (mass is None) != (radius is None):
        raise BadInput("mass: and radius go together (accepted: both, or neither)")
    for name, value in (("mass", mass), ("radius", radius), ("gravity", gravity)):
        if value is not None and not 0 < value < math.inf:
            raise BadInput(f"{name}: {value:g} (accepted: above 0)")
    for name, value in (("contact_time", contact_time), ("air", air)):
        if not 0 <= value < math.inf:
            raise BadInput(f"{name}: {value:g} (accepted: 0 or above)")


# ---- flights


def _restitutions(
    times: Array, resolution: float, contact_time: float, gravity: float, drag: float
) -> tuple[pd.DataFrame, list[str]]:
    """The table of Bounces, and notes on bounces that do not follow the others."""
    intervals = np.diff(times)
    flights = intervals - contact_time
    if (flights <= 0).any():
        raise BadInput(
            f"contact_time: {contact_time:g} s is longer than an interval between bounces"
        )
    speeds = [flight.speeds(float(lasts), gravity, drag) for lasts in flights]
    rows, notes = [], []
    for k in range(1, len(intervals)):
        before, after = speeds[k - 1][1], speeds[k][0]
        # of three onsets, that in the middle ends one flight and begins the next
        ends = 1 / flights[k - 1], 1 / flights[k - 1] + 1 / flights[k], 1 / flights[k]
        relative = resolution * math.hypot(*ends)
        rows.append(
            {
                "time": times[k],
                "speed": before,
                "restitution": after / before,
                "error": relative * after / before,
                "ratio": intervals[k] / intervals[k - 1],
            }
        )
    table = pd.DataFrame(rows)
    usual = float(np.median(np.log(table["restitution"])))
    off = np.abs(np.log(table["restitution"]) - usual)
    # an unheard bounce makes one ratio too large and the next too small
    for row in np.flatnonzero(off > max(EVEN, 6 * float(np.median(off)))).tolist():
        ratio = float(table["restitution"][row])
        what = (
            "a bounce was not heard behind it"
            if math.log(ratio) > usual
            else ("a bounce was not heard before it, or a sound was taken for one")
        )
        notes.append(f"at {table['time'][row]:.4g} s: restitution {ratio:.3g} is left out: {what}")
        table.loc[row, ["restitution", "error"]] = math.nan
    if table["restitution"].notna().sum() == 0:
        raise BadInput("times: no two flights follow each other (accepted: at least two)")
    table.attrs["units"] = {
        "time": "s",
        "speed": "m/s",
        "restitution": "1",
        "error": "1",
        "ratio": "1",
    }
    return table, notes


# ---- recordings


def heard(sound: Sound, named: str = "sound") -> tuple[Array, float, list[str]]:
    """The onsets of the bounces [s], their standard error [s], and notes.

    The loudness is the root mean square above LOWEST in windows; a bounce is LOUD times as loud as
    the noise, the median loudness, and at least ECHO of the time between the bounces before away from
    the one before.
    """
    from scipy.signal import butter, sosfilt  # take long to load

    width = max(1, round(WINDOW * sound.rate / 4))
    if len(sound.samples) < 100 * width or LOWEST > 0.4 * sound.rate:
        raise BadInput(f"{named}: {len(sound.samples)} samples at {sound.rate:g} Hz are too few")
    high = sosfilt(butter(4, LOWEST / (sound.rate / 2), "high", output="sos"), sound.samples)
    kernel = np.ones(width) / width
    loudness = np.sqrt(np.maximum(np.convolve(high**2, kernel, "same"), 0))
    noise = max(float(np.median(loudness)), sound.quantum)
    if loudness.max() <= LOUD * noise:
        raise BadInput(f"{named}: no bounce is {LOUD:g} times as loud as the noise")
    loud = np.flatnonzero(loudness > LOUD * noise)
    starts = loud[np.flatnonzero(np.diff(loud, prepend=-(10**9)) > 1)]
    onsets: list[float] = []
    for start in starts:
        quiet = start
        while quiet > 0 and loudness[quiet] > RISE * noise:
            quiet -= 1
        # the window reaches half its width ahead
        time = (quiet + width / 2) / sound.rate
        if onsets:
            before = onsets[-1] - onsets[-2] if len(onsets) > 1 else 0.2
            if time - onsets[-1] < ECHO * before:
                continue
        onsets.append(time)
    notes = [f"{len(onsets)} bounces are heard, {LOUD:g} times as loud as the noise"]
    return np.array(onsets), max(width / 2, 1) / sound.rate / math.sqrt(3), notes


def read_sound(path: Path) -> Sound:
    """The mean of the channels of a WAV file, or of another sound file by ffmpeg. Raises Unreadable
    or NotInstalled.
    """
    from scipy.io import wavfile  # takes long to load

    if not path.exists():
        raise Unreadable(f"{path}: there is no such file (accepted: a WAV file)")
    if path.suffix.lower() != ".wav":
        return _converted(path)
    try:
        rate, samples = wavfile.read(path)
    except (ValueError, OSError, EOFError) as error:
        raise Unreadable(f"{path}: is no WAV file: {brief(str(error))}") from None
    notes, quantum = [], 0.0
    if samples.dtype.kind in "iu":
        info = np.iinfo(samples.dtype)
        at_ends = np.mean((samples == info.max) | (samples == info.min))
        middle = (info.max + info.min + 1) / 2 if samples.dtype.kind == "u" else 0.0
        quantum = 1 / (float(info.max) - middle)
        samples = (samples - middle) * quantum
        if at_ends > CLIPPED:
            notes.append("the recording is clipped: onsets stay, loudness is wrong")
    samples = samples.astype(float)
    if samples.ndim == 2:
        notes.append(f"mean of {samples.shape[1]} channels")
        samples = samples.mean(axis=1)
    if not len(samples) or not np.isfinite(samples).all():
        raise Unreadable(f"{path}: has no samples, or some that are no numbers")
    return Sound(samples, float(rate), quantum, tuple(notes))


def _converted(path: Path) -> Sound:
    program = shutil.which("ffmpeg")
    if not program:
        raise NotInstalled(
            f"{path}: is no WAV file; ffmpeg would read it: apt-get install ffmpeg, or save it as WAV"
        )
    with tempfile.TemporaryDirectory() as folder:
        wav = Path(folder) / "sound.wav"
        words = [program, "-v", "error", "-i", str(path.absolute()), "-ac", "1", str(wav)]
        done = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            raise Unreadable(f"{path}: ffmpeg cannot read it: {brief(last)}")
        return read_sound(wav)


def _read_times(path: Path) -> Array:
    try:
        table = pd.read_csv(path)
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path} cannot be read: {brief(str(error))}") from None
    if "time" not in table:
        raise BadInput(f"{path}: has no column time (accepted: the times of the bounces in s)")
    times: Array = pd.to_numeric(table["time"], errors="coerce").to_numpy(float)
    if not np.isfinite(times).all():
        row = int(np.flatnonzero(~np.isfinite(times))[0]) + 1
        raise BadInput(f"{path}: row {row} of time is no number")
    return times


def main(argv: list[str]) -> int:
    """The command `ffimpact bounces`: prints the restitution of each bounce."""
    parser = argparse.ArgumentParser(
        prog="ffimpact bounces", description="Restitution from the sound of a bouncing ball."
    )
    parser.add_argument(
        "file",
        metavar="FILE",
        help="WAV, another sound file by ffmpeg, or CSV with a column time [s]",
    )
    parser.add_argument("--mass", type=float, help="of the ball [kg], for the drag of the air")
    parser.add_argument("--radius", type=float, help="of the ball [m], for the drag")
    parser.add_argument("--contact-time", type=float, default=0.0, help="of a bounce [s]")
    parser.add_argument("--figure", metavar="PNG", type=Path, help="draw loudness and onsets")
    options = parser.parse_args(argv)
    drop = bounces(
        options.file, mass=options.mass, radius=options.radius, contact_time=options.contact_time
    )
    print(drop.table.to_string(index=False, float_format=lambda x: f"{x:.5g}"))
    print(
        "units: " + ", ".join(f"{name} {unit}" for name, unit in drop.table.attrs["units"].items())
    )
    value, error = drop.restitution
    print(
        f"restitution {value:.4f} +- {error:.4f} (median; onsets to {1e3 * drop.resolution:.2g} ms)"
    )
    for note in drop.notes:
        print(f"  {note}")
    if options.figure:
        import matplotlib.pyplot as plt

        from .report.figures import save

        figure, ax = plt.subplots()
        drop.plot(ax)
        save(figure, options.figure)
    return 0
