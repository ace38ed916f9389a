"""What the views of a project are made from: history, and what tells that it may have changed."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import identify_history
from tests import repositories

PROJECT = "archgen: 1\ngroups: {a: {components: {b: {outputs: {x: T}}}}}\n"


def test_a_deepened_clone_has_another_history(tmp_path: Path) -> None:
    origin = repositories.repository(tmp_path / "origin", {"archgen.yaml": PROJECT})
    for number in range(4):
        repositories.commit(origin, {"archgen.yaml": f"{PROJECT}# {number}\n"})
    repositories.git(tmp_path, "clone", "-q", "--depth", "1", f"file://{origin}", "clone")
    clone = tmp_path / "clone"

    def identity() -> str:
        return identify_history(pipeline.check_project(clone), OutputOptions())

    identities = [identity(), identity()]
    assert identities[0] == identities[1]
    # HEAD stays, and the clone stays shallow.
    repositories.git(clone, "fetch", "-q", "--deepen", "1")
    identities.append(identity())
    repositories.git(clone, "fetch", "-q", "--unshallow")
    identities.append(identity())
    assert len(set(identities)) == 3
    assert {text.split()[0] for text in identities} == {repositories.git(clone, "rev-parse", "HEAD")}
