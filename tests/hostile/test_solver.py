"""The runs of a scene: the run for the error estimate uses a second core if one is free; results
after the loss of a run."""

import pytest

from ffimpact.freefem import freefem
from tests.support.kills import at_work
from tests.support.solver import ANSWERS, go


@pytest.mark.robustness
@pytest.mark.parametrize("lost", ["checkpoint", "coarser/checkpoint"])
def test_each_goes_on_from_its_own_checkpoint(monkeypatch, tmp_path, lost):
    """If only one of the two runs has a checkpoint, the same command repeats the other one with the
    same results."""
    monkeypatch.setattr(freefem, "CORES", 2)
    out, real = tmp_path / "out", freefem.Process.end
    straight = go("disc-normal", tmp_path / "straight", checkpoint_every="5", accuracy="0.003")

    def killed(process, progress=None, every=0.0):
        while not all((tmp_path / "out.part" / name).exists() for name in ("checkpoint", "coarser/checkpoint")):
            assert process.child.poll() is None, "it ended before it could be killed"
        raise KeyboardInterrupt
    monkeypatch.setattr(freefem.Process, "end", killed)
    with pytest.raises(KeyboardInterrupt):
        go("disc-normal", out, checkpoint_every="5", accuracy="0.003")
    monkeypatch.setattr(freefem.Process, "end", real)
    assert not at_work(tmp_path)
    (tmp_path / "out.part" / lost).unlink()
    result = go("disc-normal", out, checkpoint_every="5", accuracy="0.003")
    assert all((straight.folder / file).read_bytes() == (out / file).read_bytes() for file in ANSWERS)
    assert result.summary["estimated_error"] == straight.summary["estimated_error"] and not list(tmp_path.glob("out.*"))
