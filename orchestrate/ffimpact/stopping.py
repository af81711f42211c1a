"""Signals that end a program: obeyed at any moment, but not where Python would not survive it, or lose it."""

import os
import signal
import sys
import time
from _thread import start_new_thread
from collections.abc import Callable

_leaving = False        # a signal has raised: what is tidied up on the way out is not to be interrupted by another


def obey() -> None:
    """From here on SIGTERM and SIGHUP end this program with exit code 128 + number, and Ctrl-C with KeyboardInterrupt, in order."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        on(number, leave)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:   # a shell's background job ignores it
        on(signal.SIGINT, lambda number: signal.default_int_handler(number, None))


def leave(number: int) -> None:
    """Out, as if the signal had ended the program, but through every `finally`."""
    sys.exit(128 + number)


def on(number: int, act: Callable[[int], None]) -> None:
    """Lets the signal `number` call `act`, which raises.

    It waits while a module is being imported (extension modules and importlib abort, or swallow it) and while a child is being
    started (it would be left alone); it comes again where the exception was lost (in a callback or a destructor). What follows a signal
    that ends the program is not heard: an exception amid the end of a child would leave locks of the library held for ever.
    """
    def handler(number: int, frame) -> None:
        global _leaving
        if _leaving:
            return
        while frame:
            if frame.f_code.co_filename.startswith("<frozen importlib") or frame.f_code.co_name == "_execute_child":
                return _again(number)
            frame = frame.f_back
        try:
            act(number)
        except BaseException as error:
            error.signal = number
            _leaving = number != signal.SIGALRM      # after which the program goes on
            raise
    signal.signal(number, handler)
    sys.unraisablehook = _lost


def _again(number: int) -> None:
    start_new_thread(_send_later, (number,))        # no Timer: it takes a lock, and another signal may come here while it holds it


def _send_later(number: int) -> None:
    time.sleep(0.01)
    os.kill(os.getpid(), number)                    # to the process: this wakes the main thread


def _lost(unraisable) -> None:
    global _leaving
    if number := getattr(unraisable.exc_value, "signal", None):
        _leaving = False
        _again(number)
    else:
        sys.__unraisablehook__(unraisable)
