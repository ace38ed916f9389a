"""110 slips are typed in an editor, and the first quick fix is taken: most are mended so, and none becomes something else."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import CheckedProject
from tests.lsp.client import Client
from tests.lsp.test_edits import apply_edit
from tests.planted_slips import FILE, SEED, Slip, is_same_model, judge_text, list_slips

_COUNT = 110
_LEAST_MENDED = 60
_PATIENCE = 6
_EVERYTHING = {"start": {"line": 0, "character": 0}, "end": {"line": 999, "character": 0}}


def type_slip(client: Client, slip: Slip, seed: CheckedProject) -> str:
    """Type a slip, take the first quick fix of what is most serious and new, and say what came of it."""
    meant = judge_text(slip.meant) if slip.meant else seed
    known = {(finding.rule, finding.message) for finding in (*seed.findings, *meant.findings)}
    client.write(FILE, slip.text)

    def list_news() -> list[dict[str, Any]]:
        news = (
            each for each in client.wait_for(FILE) if (each["code"], each["message"].partition("\n")[0]) not in known
        )
        return sorted(news, key=lambda each: each["severity"])

    found = list_news()
    for _ in range(_PATIENCE):  # what a half-written name means is not told at once
        if found and found[0]["severity"] == 1:
            break
        client.rest(0.25)
        found = list_news()
    for finding in found:
        context = {"diagnostics": [finding], "only": ["quickfix"]}
        actions: list[Any] = client.of("codeAction", FILE, range=finding["range"], context=context)
        fixes = [each for each in actions if not each["title"].startswith("silence")]
        if len(fixes) > 1 and not any(each.get("isPreferred") for each in fixes):
            return "a choice"  # which unit was meant only a person knows
        if fixes:
            text = apply_edit({FILE: slip.text}, client.folder, fixes[0]["edit"])[FILE]
            mended = judge_text(text)
            if is_same_model(mended.architecture, meant.architecture):
                return "mended"
            return "wrong still" if mended.has_errors else "something else"
    return "no fix" if found else "not seen"


@pytest.mark.slow
def test_the_first_fix_mends_most_slips_and_makes_none_mean_something_else(tmp_path: Path) -> None:
    slips = list(list_slips())
    chosen = [slips[number * len(slips) // _COUNT] for number in range(_COUNT)]
    (tmp_path / FILE).write_text(SEED, encoding="utf-8")
    seed = judge_text(SEED)
    with Client(tmp_path.resolve()) as client:
        client.open(FILE)
        verdicts = {f"{slip.kind}: {slip.name}": type_slip(client, slip, seed) for slip in chosen}
    counts = Counter(verdicts.values())
    assert [name for name, verdict in verdicts.items() if verdict == "something else"] == []
    assert counts["mended"] >= _LEAST_MENDED, (counts, verdicts)
