"""Progress of a computation: the current work, the completed fraction and the remaining time. On a
terminal or in a notebook it is one line that changes. In a pipe or a file it is a line from time to
time.

Work that consists of parts has one line for all of them. The progress lines of its parts are merged
into that line, both for parts in the same thread (Line.part, in_turn) and for parts in other
threads (forward, in study.run_parallel). Work that has no fraction is announced if it takes long
(work).
"""

import contextlib
import math
import sys
import threading
import time
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping
from typing import Any, TypeVar

T = TypeVar("T")

__all__ = ["Line", "forward", "in_notebook", "in_turn", "muted", "work"]

FORMAT = "{desc} {percentage:3.0f}% |{bar}| {elapsed}, {remaining} left"
SLOW = 1.5  # duration [s] from which on work is announced
# In a pipe the first line comes after SELDOM [s], the next ones when the elapsed time has grown by
# SELDOM or by its share LATER, whichever is longer. A run of ten hours has some 80 lines.
SELDOM, LATER = 20.0, 0.1
# A receiver of progress: the completed fraction, in [0, 1], and a description of the current work.
Tell = Callable[[float, str], None]


class _Thread(threading.local):
    """The receiver of the progress lines that a thread makes. If it is None, the lines are
    shown. `muted`: nothing is announced.
    """

    tell: Tell | None = None
    muted: bool = False


_thread = _Thread()


@contextlib.contextmanager
def _in_this_thread(name: str, value: object) -> Iterator[None]:
    """Sets a value of this thread inside the `with`."""
    before = getattr(_thread, name)
    setattr(_thread, name, value)
    try:
        yield
    finally:
        setattr(_thread, name, before)


def forward(tell: Tell) -> contextlib.AbstractContextManager[None]:
    """Sends the progress of the lines that this thread makes inside the `with` to `tell`, which
    shows it as part of another line.
    """
    return _in_this_thread("tell", tell)


def muted(quiet: bool = True) -> contextlib.AbstractContextManager[None]:
    """Announces no work of this thread inside the `with` if `quiet`."""
    return _in_this_thread("muted", quiet)


@contextlib.contextmanager
def work(words: str) -> Iterator[None]:
    """Prints `words` on stderr once the work inside the `with`, or a decorated function, has taken
    SLOW seconds. Parts of other work print nothing.
    """
    if _thread.muted or _thread.tell:
        yield
        return
    timer = threading.Timer(SLOW, _say, [f"ffimpact: {words} ..."])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def _say(sentence: str) -> None:
    from tqdm import tqdm

    tqdm.write(sentence, file=sys.stderr)
    sys.stderr.flush()


def in_notebook() -> bool:
    return "ipykernel" in sys.modules


class _Printed:
    """Progress in a pipe or a file: whole lines on stderr, with long intervals (SELDOM)."""

    def __init__(self) -> None:
        self.start = self.last = time.monotonic()

    def show(self, share: float, words: str) -> None:
        """Prints a line if the last one was long enough ago."""
        now = time.monotonic()
        elapsed = now - self.start
        if now - self.last < max(SELDOM, LATER * elapsed):
            return
        self.last = now
        remaining = f", {_clock(elapsed * (1 / share - 1))} left" if share > 0 else ""
        _say(f"ffimpact: {100 * share:.0f} % after {_clock(elapsed)}{remaining}: {words}")

    def close(self) -> None:
        """Prints nothing: what follows is the report of the run."""


def _clock(seconds: float) -> str:
    """Returns a duration as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    return (
        f"{minutes // 60}:{minutes % 60:02}:{rest:02}" if minutes >= 60 else f"{minutes}:{rest:02}"
    )


class _Bar:
    """Progress on a terminal or in a notebook: a line that changes."""

    def __init__(self, words: str) -> None:
        if in_notebook():
            from tqdm.auto import tqdm
        else:
            from tqdm import tqdm
        from tqdm.contrib import DummyTqdmFile

        self.leaving = contextlib.ExitStack()
        if sys.stdout.isatty():  # printed text appears above the line
            self.leaving.enter_context(contextlib.redirect_stdout(DummyTqdmFile(sys.stdout)))
        self.bar = tqdm(total=1.0, desc=words, leave=False, bar_format=FORMAT)

    def show(self, share: float, words: str) -> None:
        self.bar.n = share
        self.bar.set_description_str(words)

    def close(self) -> None:
        self.bar.close()
        self.leaving.close()


class Line(contextlib.AbstractContextManager["Line", None]):
    """Progress of the work `name`. `costs` maps each part to its cost, in any unit. With `watched` =
    False nothing is shown.
    """

    def __init__(
        self,
        name: str,
        costs: Mapping[Any, float],
        watched: bool | None = None,
        words: str = "",
    ):
        self.name, self.costs, self.shares = name, dict(costs), dict.fromkeys(costs, 0.0)
        self.outer, self.quiet = _thread.tell, watched is False
        self.shown: _Bar | _Printed | None = None
        if not (self.outer or self.quiet):
            on_screen = sys.stderr.isatty() or in_notebook()
            self.shown = _Bar(self._words(words)) if on_screen else _Printed()

    def __exit__(self, *_: object) -> None:
        if self.shown:
            self.shown.close()

    def at(self, part: Hashable, share: float, words: str = "", cost: float = 1.0) -> None:
        """Reports that the fraction `share`, in [0, 1], of a part is completed. A part that was not
        expected is added with its `cost`. The fraction never decreases.
        """
        self.costs.setdefault(part, cost)
        self.shares[part] = (
            min(1.0, max(share, self.shares.get(part, 0.0)))
            if math.isfinite(share)
            else self.shares.get(part, 0.0)
        )
        done = sum(self.costs[name] * fraction for name, fraction in self.shares.items()) / (
            sum(self.costs.values()) or 1.0
        )
        if self.outer:
            self.outer(done, self._words(words))
        elif self.shown:
            self.shown.show(done, self._words(words))

    def _words(self, words: str) -> str:
        return f"{self.name}: {words}" if words else self.name

    def say(self, sentence: str) -> None:
        """Prints a sentence above the line."""
        if not self.quiet:
            _say(sentence)

    @contextlib.contextmanager
    def part(self, part: Hashable, words: str) -> Iterator[None]:
        """Context manager: work inside the `with` is this part, and its progress lines are merged
        into this line.
        """
        self.at(part, 0.0, words)
        with forward(lambda share, inner: self.at(part, share, f"{words}, {inner}")):
            yield
        self.at(part, 1.0, words)


def in_turn(name: str, items: Iterable[T]) -> Iterator[T]:
    """Yields the items one after another, with a line that shows the number of the current item."""
    items = list(items)
    with Line(name, dict.fromkeys(range(len(items)), 1.0)) as line:
        for k, item in enumerate(items):
            with line.part(k, f"{k + 1} of {len(items)}"):
                yield item
