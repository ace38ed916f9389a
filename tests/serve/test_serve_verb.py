"""The verb in this process: what it says, opens and writes."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from archgen.cli import main
from archgen.live import file_watch
from tests.running import ROOT
from tests.serve.conftest import ROBOT


def test_it_tells_its_address_opens_it_and_prints_errors_as_check_does(
    robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    seen = threading.Event()

    def open_page(url: str) -> bool:
        opened.append(url)
        seen.set()
        return True

    def watch(choose_places: Callable[[], object], on_change: Callable[[], None], _stopped: object) -> None:
        assert choose_places()
        (robot / "archgen.yaml").write_text(ROBOT.replace("inputs:", "imputs:"))
        on_change()
        (robot / "archgen.yaml").unlink()
        on_change()
        assert seen.wait(120)
        raise KeyboardInterrupt

    monkeypatch.setattr(webbrowser, "open", open_page)
    monkeypatch.setattr(file_watch, "watch_files", watch)
    result = CliRunner().invoke(main, ["serve", str(robot), "--port", "0", "--open"])
    assert result.exit_code == 0
    address = re.search(
        r"^serving Robot at (http://127\.0\.0\.1:\d+/)  \(Ctrl-C ends it\)$", result.stdout, re.MULTILINE
    )
    assert address
    assert opened == [address[1]]
    assert "did you mean `inputs`?" in result.stderr
    assert result.stderr.count("did you mean `inputs`?") == 1
    assert re.search(r"error: .*archgen\.yaml.*\n\nstopped\n\Z", result.stderr), result.stderr
    assert not (robot / "archgen-out").exists()


def test_a_port_beyond_all_ports_is_wrong_usage(robot: Path) -> None:
    assert CliRunner().invoke(main, ["serve", str(robot), "--port", "70000"]).exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_what_ends_it_from_outside_lets_it_tidy_up(robot: Path, number: signal.Signals, tmp_path: Path) -> None:
    (tmp_path / "tmp").mkdir()
    with subprocess.Popen(  # noqa: S603 - our own program
        [sys.executable, "-m", "archgen", "serve", robot, "--port", "0"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path / "tmp")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as served:
        assert served.stdout
        while "serving" not in (line := served.stdout.readline()):
            assert line
        served.send_signal(number)
        assert served.communicate(timeout=120)[1].endswith("stopped\n")
    assert served.returncode == 0
    assert list((tmp_path / "tmp").iterdir()) == []
