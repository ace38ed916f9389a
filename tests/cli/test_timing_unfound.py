"""Five callbacks of one thread, all of whose figures are written: where the search finds no bound, none is called unknown."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run

# Each fires the next, and may start a little late, so that it is part of no run: 40 % of a core.
FIVE = "\n".join(
    [
        "groups:\n  g:\n    components:",
        "      c0: {outputs: {out: std_msgs/msg/Empty}}",
        *(f"      c{at}: {{inputs: {{i: c{at - 1}.out}}, outputs: {{out: std_msgs/msg/Empty}}}}" for at in range(1, 5)),
        "hosts: {cpu: {cores: 1}}\ncontainers: {box: {threads: 1, host: cpu}}\nnodes:",
        "  n0: {implements: c0, container: box, timing: {period: 100 ms, jitter: 0 ms, wcet: 8 ms, bcet: 8 ms}}",
        *(
            f"  n{at}: {{implements: c{at}, container: box, timing: {{jitter: 1 us, wcet: 8 ms, bcet: 8 ms}}}}"
            for at in range(1, 5)
        ),
        "chains: {c: {through: [g.c0, g.c1, g.c2, g.c3, g.c4], deadline: 200 ms}}",
    ]
)


@pytest.mark.parametrize("question", [(), ("--chain", "c"), ("--sensitivity", "c"), ("--why", "n3")])
def test_no_bound_was_found_and_nothing_that_is_written_is_unknown(
    run: Run, tmp_path: Path, question: tuple[str, ...]
) -> None:
    (tmp_path / "five.yaml").write_text(FIVE, encoding="utf-8")
    said = run("timing", tmp_path / "five.yaml", *question).out
    assert "no bound found on cpu at a load of 40 % (one thread in any order)" in said
    assert not [word for word in ("diverged", "unbounded", "unknown", "MISSED", "measured") if word in said]


def test_check_says_that_the_deadline_is_not_proven(run: Run, tmp_path: Path) -> None:
    (tmp_path / "five.yaml").write_text(FIVE, encoding="utf-8")
    assert (
        "warning[late-chain]: nothing proves that the chain `c` meets its deadline of 200 ms: "
        "no bound was found on `cpu` at a load of 40 %\n"
    ) in run("check", tmp_path / "five.yaml").out
