"""A comparison as the comment on a pull request: what a reviewer reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.compare.comparison import PartnerBreak
from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.source_span import Span
from archgen.emit.markdown import comparison_markdown
from archgen.emit.markdown.comparison_markdown import MAX_COMMENT_SIZE
from archgen.model.project_settings import AcceptedChange, BreakPolicy
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.changes.comparison_document import ReadingErrors, describe_comparison
from archgen.views.graphs.changes import SMALL_BUDGET, draw_changes

ROBOT = """\
archgen: 1
project: {id: robot}
rules: {missing-detail: "off"}
partners: {certh: CERTH, sssa: SSSA}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: Image}}
  display:
    title: Display
    owner: sssa
    components:
      finder: {inputs: {image: camera.image}, outputs: {people: People}}
      screen: {inputs: {people: finder.people}}
types: {Image: sensor_msgs/msg/Image, People: geometry_msgs/msg/PoseArray}
nodes:
  camera: {implements: camera, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  finder: {implements: finder, timing: {behaviour: event, wcet: 20 ms}, host: pc}
  screen: {implements: screen, timing: {behaviour: event, wcet: 5 ms}, host: pc}
hosts: {pc: {cores: 4}}
chains: {see: {through: [camera, finder, screen], deadline: 150 ms}}
"""
Told = Callable[..., str]


@pytest.fixture
def told(tmp_path: Path) -> Told:
    """Give the comment on what turns ROBOT into another text."""

    def tell(*changes: tuple[str, str], before: str = ROBOT, most: int = MAX_COMMENT_SIZE) -> str:
        after = before
        for old, new in changes:
            assert old in after
            after = after.replace(old, new)
        return written(*comparison(tmp_path, before, after), limit=most)

    return tell


def written(found: Comparison, broken: ReadingErrors, *, limit: int = MAX_COMMENT_SIZE) -> str:
    """Write the comment on a comparison."""
    document = describe_comparison(found, "main", "arm", broken, draw_changes(found, SMALL_BUDGET))
    return comparison_markdown.write_comparison_markdown(document, "archgen diff main arm", limit=limit)


def comparison(folder: Path, before: str, after: str) -> tuple[Comparison, ReadingErrors]:
    """Compare two one-file projects."""
    sides = []
    for name, text in (("before", before), ("after", after)):
        (folder / name).mkdir(exist_ok=True)
        (folder / name / "robot.yaml").write_text(text, encoding="utf-8")
        sides.append(ProjectVersion(name, pipeline.check_project(folder / name / "robot.yaml")))
    old, new = sides
    return (
        compare_named_versions(old, new),
        ReadingErrors(old.checked_project.structural_errors, new.checked_project.structural_errors),
    )


def test_nothing_changed(told: Told) -> None:
    assert (
        told(("archgen: 1", "# only a comment\narchgen: 1")) == "### No change of the architecture\n\n`main` → `arm`\n"
    )


def test_what_is_late_in_a_variant_too_is_found_at_one_place(told: Told) -> None:
    before = ROBOT + "variants: {slow: {changes: {nodes: {camera: {timing: {wcet: 3 ms}}}}}}\n"
    text = told(("wcet: 20 ms", "wcet: 60 ms"), before=before)
    assert "found as `late-chain` at `robot.yaml:22:10`\n" in text


def test_a_chain_that_misses_its_deadline_now(told: Told) -> None:
    assert (
        told(("wcet: 20 ms", "wcet: 60 ms"))
        == """\
### 1 change of the architecture: breaks CERTH, also concerns SSSA

`main` → `arm`: 1 changed

#### Breaking changes

> [!CAUTION]
> 1 change breaks another partner.

- \\~ `display.finder` of SSSA: worst case execution time `20 ms` → `60 ms`
  - **breaks CERTH** (promise): makes the chain `see` miss its deadline of 150 ms (127 ms → 167 ms); `camera` of CERTH is on it
  - found as `late-chain` at `robot.yaml:22:10`

#### Load of hosts and links

- \\~ host `pc`: 6.8 % → 16.8 % of its cores; used by CERTH and SSSA

#### Latency of chains

| chain | before | after | difference | deadline | verdict |
| --- | --- | --- | --- | --- | --- |
| `see` | 127 ms | 167 ms | \\+40 ms | 150 ms | **missed (was met)** |

```mermaid
flowchart LR
  n2("Camera<br>Sensing"):::neighbour
  subgraph g0["Display"]
    n0[["#126; Finder"]]:::changed
    n1("Screen"):::neighbour
  end
  n2 --> n0
  n0 --> n1
  classDef changed stroke:#b7791f,stroke-width:2px
  classDef neighbour stroke:#8a8a8a,stroke-width:1px
```

<sub>\\+ added, \u2212 removed, \\~ changed, → renamed or moved; the rest is as before.</sub>
"""
    )


def test_what_breaks_a_partner_stands_first_with_whom_and_why(tmp_path: Path) -> None:
    after = ROBOT.replace("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage").replace(
        "rate: 10 Hz", "rate: 20 Hz"
    )
    found, broken = comparison(tmp_path, ROBOT, after)
    kind, rate = found.changes
    assert (kind.element_kind, rate.element_kind) == ("type", "component")
    breaks = (
        PartnerBreak("sssa", "`display.finder` takes `Image`", "agreed in May", hash="cfa9c1", agreed_hash="cfa9c1"),
        PartnerBreak("sssa", "two", "agreed in May", "meaning", hash="cfa9c1", agreed_hash="cfa9c1"),
        PartnerBreak("certh", "two", category="meaning", hash="cfa9c1"),
    )
    claims = (AcceptedChange("Image", "agreed in *June*", "message", Span("archgen.yaml", 1, 1, 1, 1)),)
    kind = replace(kind, breaks=breaks, claims=claims)
    text = written(replace(found, changes=(rate, kind)), broken)
    assert text.startswith("""\
### 2 changes of the architecture: breaks CERTH and SSSA

`main` → `arm`: 2 changed

#### Breaking changes

> [!CAUTION]
> 1 change breaks another partner.

- \\~ type `Image` now is `sensor_msgs/msg/CompressedImage` instead of `sensor_msgs/msg/Image`; `sensing.camera.image` carries it
  - **breaks SSSA** (wire): `display.finder` takes `Image`
  - **breaks CERTH and SSSA** (meaning): two
  - accepted by SSSA: agreed in May
  - said in `archgen.yaml`, not by CERTH and SSSA: agreed in \\*June\\*

#### Other changes

**Sensing · `sensing` (CERTH)**

- \\~ `sensing.camera`: rate `10 Hz` → `20 Hz`
""")
    refused = replace(found, changes=(kind,), policy=BreakPolicy(meaning=Severity.ERROR))
    assert (
        "\n`review.breaking: {meaning: error}` refuses this: mend it, or CERTH says why it is right:\n\n"
        "```yaml\n# review/certh.yaml\nreview:\n  accepted:\n    Image: {key: message, was: cfa9c1, reason: THE REASON}\n```\n"
    ) in written(refused, broken)


def test_a_message_changes_for_who_reads_the_type(told: Told) -> None:
    text = told(("Image: sensor_msgs/msg/Image", "Image: sensor_msgs/msg/CompressedImage"))
    assert text.startswith("### 1 change of the architecture: breaks SSSA, also concerns CERTH\n")
    assert '  n0 -->|"#33; Image"| n1\n' in text
    assert "  linkStyle 0 stroke:#d1242f,stroke-width:4px\n" in text
    assert "Red with \\!: breaks another partner." in text


def test_a_version_with_errors_says_so_first_and_does_not_call_anything_cured(told: Told) -> None:
    text = told(("camera.image", "camera.imag"))
    assert text.startswith("### ")
    lines = text.split("\n")
    assert lines[0].startswith("### 1 change of the architecture in what could be read")
    assert lines[4] == "**`arm` is not sound** (1 error). What cannot be read there is left out of the comparison:"
    assert lines[6].startswith("- error `unknown-reference`: ")
    assert text.count("unknown-reference") == 1
    assert "cured" not in text


def test_a_version_that_does_not_parse(told: Told) -> None:
    assert told(("types: {", "types: [{")).startswith("### Cannot be judged: `robot.yaml` cannot be read\n")


def test_texts_are_folded_unless_there_is_only_one(told: Told) -> None:
    one = told(
        ("    title: Display\n", "    title: Screens\n"), ("  screen: {implements", "  screen_node: {implements")
    )
    assert "**Texts and pictures only**\n\n- \\~ " in one
    assert "<details>" not in one
    two = told(
        ("    title: Display\n", "    title: Screens\n"),
        ("    components:\n      finder:", "    description: Shows it\n    components:\n      finder:"),
    )
    assert "<details><summary>2 changes of texts and pictures only</summary>\n\n- \\~ " in two
    assert "\n\n</details>" in two


def test_many_changes_of_one_group_are_folded_and_drawn_as_one_box(told: Told) -> None:
    many = "".join(f"      part{at}: {{inputs: {{image: camera.image}}}}\n" for at in range(60))
    text = told(("      finder:", f"{many}      finder:"))
    assert "<details><summary>52 more changes</summary>" in text
    assert text.startswith("### 60 changes of the architecture: concerns CERTH and SSSA\n")
    assert '("Display<br>#8203;+ 60 components"):::added' in text
    assert "1 group folded to one box each" in text


@pytest.mark.parametrize("most", [1500, 3000, 6000, 10_000])
def test_what_does_not_fit_is_counted(told: Told, most: int) -> None:
    many = "".join(f"      part{at}: {{inputs: {{image: camera.image}}, outputs: {{o: Image}}}}\n" for at in range(60))
    text = told(("      finder:", f"{many}      finder:"), most=most)
    assert len(text) <= most
    assert "`archgen diff main arm`" in text
    assert text.count("<details>") == text.count("</details>")
    assert text.count("```") % 2 == 0


@pytest.mark.slow
def test_a_whole_comment_keeps_to_the_limit_of_the_host(told: Told) -> None:
    many = "".join(
        f'      part{at}: {{title: "{"&" * 60} {at}", inputs: {{image: camera.image}}}}\n' for at in range(900)
    )
    text = told(("      finder:", f"{many}      finder:"))
    assert 60_000 < len(text) <= 65_336
    assert " more: `archgen diff main arm`" in text


def test_where_the_repository_is_known_elements_are_titles_with_links(tmp_path: Path) -> None:
    found, broken = comparison(tmp_path, ROBOT, ROBOT.replace("wcet: 20 ms", "wcet: 60 ms"))
    document = describe_comparison(found, "main", "arm", broken)
    address = "https://github.com/lab/a b/blob/1a2b3c4/robot.yaml#L12"
    document = replace(
        document,
        element_titles={"display.finder": "Finder [x] @all"},
        element_addresses={"display.finder": f"{address}>)<"},
    )
    text = comparison_markdown.write_comparison_markdown(document)
    link = "https://github.com/lab/a%20b/blob/1a2b3c4/robot.yaml#L12%3E%29%3C"
    assert f"- \\~ [Finder \\[&#8203;x\\] @&#8203;all](<{link}>) of SSSA: worst case" in text
    assert "`display.finder`" not in text
