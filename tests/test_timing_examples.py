"""The page that walks through the examples, and the table in the case study's README: all their output is real.

`make golden` renews the output below each command.
"""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner

from archgen.cli import main
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.judged_projects import judge_ramcip
from tests.running import RAMCIP, ROOT

PAGE = ROOT / "docs" / "timing_examples.md"
_BLOCK = re.compile(r"^```console\n\$ archgen ([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_ROW = re.compile(r"^\| `(\w+)` \| (.+?) \| (.+?) \| (.+?) \| (.+?) \|$", re.MULTILINE)
_MS = 10**6


_PROJECT = re.compile(r"^```yaml\n(# courier\.yaml.*?)^```$", re.MULTILINE | re.DOTALL)


def run(words: str, courier: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Give a block of the page with what the command prints now; the page's own robot lies in a folder of its own."""
    monkeypatch.chdir(courier if "courier.yaml" in words else ROOT)
    done = CliRunner().invoke(main, words.split(), catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return f"```console\n$ archgen {words}\n{done.output.strip()}\n```"


@pytest.mark.slow
def test_the_output_on_the_page_is_real(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    # pytest-xdist exports the width of its own terminal.
    monkeypatch.delenv("COLUMNS", raising=False)
    page = PAGE.read_text(encoding="utf-8")
    (tmp_path / "courier.yaml").write_text(_PROJECT.findall(page)[0], encoding="utf-8")
    fresh = _BLOCK.sub(lambda block: run(block[1], tmp_path, monkeypatch), page)
    if request.config.getoption("--update-golden"):
        PAGE.write_text(fresh, encoding="utf-8")
        return
    assert len(_BLOCK.findall(page)) == 7
    assert page == fresh, "run `make golden`, and look at what changed"


@pytest.fixture(scope="module")
def analysed() -> tuple[Analysis, dict[str, ChainResult]]:
    architecture = judge_ramcip().architecture
    found = analyse_architecture(architecture)
    return found, bound_all_chains(found, architecture)


def test_seven_chains_of_the_case_study_meet_their_deadlines_and_one_is_open(
    analysed: tuple[Analysis, dict[str, ChainResult]],
) -> None:
    _, found = analysed
    verdicts = {name: chain.verdict for name, chain in found.items()}
    assert verdicts.pop("missed_dose_to_mark") == "open"
    assert len(verdicts) == 7
    assert set(verdicts.values()) == {"met"}
    assert found["missed_dose_to_mark"].bound.missing == ("light_engine",)


def test_no_host_of_the_case_study_is_overloaded(analysed: tuple[Analysis, dict[str, ChainResult]]) -> None:
    analysis, _ = analysed
    assert {name for name, host in analysis.hosts.items() if host.verdict == "overload"} == set()
    assert {name for name, host in analysis.hosts.items() if host.verdict == "unknown"} == {"light_board"}
    unbounded = {name for name, response in analysis.responses.items() if response.worst.value is None}
    assert unbounded == {"light_engine"}
    assert (analysis.diverged, analysis.endless, analysis.deadlocked) == ((), (), ())


def test_the_readme_of_the_case_study_says_what_comes_out(
    analysed: tuple[Analysis, dict[str, ChainResult]],
) -> None:
    _, found = analysed
    rows = {row[0]: row[1:] for row in _ROW.findall((RAMCIP / "README.md").read_text(encoding="utf-8"))}
    assert set(rows) == set(found)
    for name, (best, bound, deadline, verdict) in rows.items():
        chain = found[name]
        assert chain.deadline is not None
        assert chain.bound.value is not None
        assert chain.best.value is not None
        at_least = "" if chain.bound.complete else "at least "
        assert (best, bound) == (at_least + shown(chain.best.value), at_least + shown(chain.bound.value)), name
        assert (deadline, verdict) == (shown(chain.deadline.value or Fraction(0)), chain.verdict), name


def shown(ns: Fraction) -> str:
    """Write a duration as the table does: rounded to a millisecond, seconds from one on."""
    ms = ns / _MS
    return f"{round(ms)} ms" if ms < 1000 else f"{float(round(ms / 1000, 2)):g} s"
