"""The section `agreements`: what is declared, and what is wrong with it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.link.declare.section_declaration import declare_agreements

ROBOT = """\
archgen: 1
partners: {a: A, b: B}
groups: {g: {owner: a, components: {eye: {outputs: {scan: Scan}}}}}
agreements:
"""


def check(folder: Path, agreements: str) -> list[str]:
    (folder / "archgen.yaml").write_text(ROBOT + agreements, encoding="utf-8")
    findings = pipeline.check_project(folder).findings
    return [f"{each.span.line}: {each.message}; {each.help}" for each in findings if each.severity == "error"]


def test_terms_and_signatures_are_data(tmp_path: Path) -> None:
    body = """\
  a-b:
    terms: {notice: 30 days, stamps: of measuring}
    interfaces: {g.eye.scan: {stamps: of sending}, /tf: {late: stop}}
    signed: {tag: t, by: {a: Ada}, versions: {a: {g.eye.scan: "012345"}}}
"""
    assert check(tmp_path, body) == []
    (agreement,) = pipeline.check_project(tmp_path).architecture.agreements.values()
    assert (agreement.pair, agreement.binding_signature) == (("a", "b"), None)
    assert agreement.find_term("stamps", "g.eye.scan") == "of sending"
    assert agreement.find_term("stamps", "/tf") == "of measuring"
    assert agreement.signed is not None
    assert (agreement.signed.rules, agreement.signed.versions) == (1, {"a": {"g.eye.scan": "012345"}})
    assert {path: span.line for path, span in agreement.signed.places.items()}["a", "g.eye.scan"] == 8


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("  a-c: {}", "5: there is no partner `c`; did you mean `a`?"),
        ("  a-a: {}", "5: `a-a` names one partner twice; an agreement is between two partners"),
        ("  a-b: {}\n  b-a: {}", "6: `b-a` is `a-b` the other way round; write all of it below one of them"),
        (
            "  a-b: {interfaces: {g.eye.scam: {late: stop}}}",
            "5: no output named `g.eye.scam`; did you mean `g.eye.scan`?",
        ),
        (
            "  a: {}",
            "5: `a` cannot be a pair; an agreement is called by the ids of both partners, such as `certh-sssa`",
        ),
        (
            "  a-b: {signed: {revision: HEAD}}",
            "5: `revision` cannot be `HEAD`; a commit is named by its whole hash: 40 hexadecimal digits in quotes",
        ),
        (
            "  a-b: {signed: {terms: zz}}",
            '5: `terms` cannot be `zz`; a version is six hexadecimal digits in quotes, such as `"3fa9c1"`',
        ),
    ],
)
def test_what_is_wrong_is_told_at_its_line(tmp_path: Path, body: str, told: str) -> None:
    assert check(tmp_path, body) == [told]
    assert declare_agreements.__doc__


def test_files_of_agreements_are_read_whatever_sources_names(tmp_path: Path) -> None:
    (tmp_path / "agreements").mkdir()
    (tmp_path / "agreements" / "b-a.yaml").write_text("agreements: {b-a: {terms: {notice: none}}}", encoding="utf-8")
    text = "archgen: 1\nsources: [a.yaml]\npartners: {a: A, b: B}\n"
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "a.yaml").write_text("groups: {g: G}\n", encoding="utf-8")
    assert list(pipeline.check_project(tmp_path).architecture.agreements) == ["b-a"]
    (tmp_path / "agreements" / "b-a.yaml").rename(tmp_path / "x.txt")
    (tmp_path / "agreements" / "b-a.yaml").symlink_to(tmp_path / "x.txt")
    (error,) = [each for each in pipeline.check_project(tmp_path).findings if each.severity == "error"]
    assert "behind a symbolic link" in error.message
