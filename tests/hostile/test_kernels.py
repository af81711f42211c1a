"""The compiled kernels do not depend on the number of threads."""

import pytest

from ffimpact import scene
from ffimpact.failure import BadInput
from ffimpact.freefem import freefem
from ffimpact.running import run


@pytest.mark.robustness
def test_answers_are_the_same_with_any_number_of_threads(tmp_path, monkeypatch):
    """One thread and two threads write the same history, byte by byte. An invalid number of threads
    is refused."""
    histories = []
    for threads in ("1", "2"):
        monkeypatch.setenv("FFIMPACT_THREADS", threads)
        run.run(scene.load("ball-oblique"), {"accuracy": 0.1, "end_time": 1e-3, "fields": 0}, tmp_path / threads, estimate=False)
        histories.append((tmp_path / threads / "history.csv").read_bytes())
    assert histories[0] == histories[1]
    monkeypatch.setenv("FFIMPACT_THREADS", "none")
    with pytest.raises(BadInput, match="FFIMPACT_THREADS: 'none'"):
        freefem.find()
