"""A process that never ends fails the test that waits for it, and ends with it."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Callable

import pytest

from tests import bounded_waits

_ENDLESS = ("sleep", "600")


@pytest.mark.parametrize("wait", [subprocess.Popen.wait, subprocess.Popen.communicate])
def test_a_wait_without_a_time_ends(wait: Callable[..., object], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_waits, "LONGEST_WAIT_SECONDS", 0.1)
    with subprocess.Popen(_ENDLESS, stdout=subprocess.PIPE) as process:  # noqa: S603 - a fixed program
        with pytest.raises(subprocess.TimeoutExpired, match="sleep"):
            wait(process)
        assert process.wait(60) == -signal.SIGKILL


def test_so_does_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_waits, "LONGEST_WAIT_SECONDS", 0.1)
    with pytest.raises(subprocess.TimeoutExpired, match="sleep"):
        subprocess.run(_ENDLESS, check=False)  # noqa: S603 - as above


def test_a_time_of_ones_own_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded_waits, "LONGEST_WAIT_SECONDS", 0.0)
    subprocess.run(["sleep", "0.1"], check=True, timeout=60)  # noqa: S607 - as above
