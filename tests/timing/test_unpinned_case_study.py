"""The case study without its `core:` keys, as hardly any team pins its nodes: it still meets what it must."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.running import RAMCIP


def copy_without_cores(folder: Path) -> Path:
    """Copy the case study into a folder, without its `core:` keys."""
    project = folder / "ramcip"
    shutil.copytree(RAMCIP, project)
    file = project / "timing.yaml"
    text = file.read_text(encoding="utf-8")
    unpinned = re.sub(r"^ +core: \d+\n", "", re.sub(r", core: \d+", "", text), flags=re.MULTILINE)
    assert text.count("core: ") > 30 > unpinned.count("core: ")
    file.write_text(unpinned, encoding="utf-8")
    return project


@pytest.mark.slow
def test_no_chain_is_missed_where_no_node_is_pinned(tmp_path: Path) -> None:
    project = copy_without_cores(tmp_path)
    architecture = pipeline.check_project(project).architecture
    analysis = analyse_architecture(architecture)
    verdicts = {name: chain.verdict for name, chain in bound_all_chains(analysis, architecture).items()}
    assert {verdicts[name] for name in ("slip_to_grip", "contact_to_stop", "obstacle_to_stop")} == {"met"}
    assert "missed" not in verdicts.values()
    boundless = {name for name, response in analysis.responses.items() if response.worst.value is None}
    assert boundless == {"light_engine"}
    assert analysis.diverged == ()
