"""What changed since an earlier version, on the pages of the site."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from archgen.cli import main
from tests import repositories

OLD = """\
archgen: 1
project: {title: Robot}
partners: {p: {title: Partner}}
groups:
  g:
    title: Group
    components:
      eye: {owner: p, functionality: Looks at five things., outputs: {o: Seen, extra: Also}, tags: [a, b]}
      brain: {functionality: Thinks., inputs: {i: eye.o}}
      old_arm: {functionality: Moves with some force and care., outputs: {push: Push}}
      gone: {functionality: Never was., outputs: {x: Nothing}}
  h:
    title: Other
    components:
      still: {functionality: Stays.}
nodes: {eye: {implements: g.eye, timing: {period: 100 ms, wcet: 5 ms}}}
"""
NEW = (
    OLD.replace("five", "six <b>")
    .replace("tags: [a, b]", "tags: [a, c]")
    .replace(", extra: Also", "")
    .replace("old_arm:", "arm:")
    .replace(
        "      gone: {functionality: Never was., outputs: {x: Nothing}}\n", "      horn: {functionality: Honks.}\n"
    )
    .replace("wcet: 5 ms", "wcet: 7 ms")
)


def make_site(folder: Path, *words: str) -> Result:
    root = repositories.repository(folder / "robot", {"archgen.yaml": OLD})
    (root / "archgen.yaml").write_text(NEW)
    return CliRunner().invoke(main, ["site", str(root), "-o", str(folder / "site"), *words])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("since")
    result = make_site(folder, "--since", "HEAD")
    assert result.exit_code == 0, result.output
    return folder / "site"


def read(site: Path, name: str) -> str:
    return (site / name).read_text()


def text_of(html: str) -> str:
    return " ".join(re.sub(r"<[^>]+>", " ", html).split())


def test_the_page_of_changes_tells_them_and_links_them(site: Path) -> None:
    html = read(site, "changes.html")
    assert "What changed: HEAD (" in html
    assert "→ the working tree" in html
    text = text_of(html.partition("<main")[2])
    for words in ("g.arm", "renamed", "g.horn", "is added", "g.gone", "is removed", "g.eye"):
        assert words in text
    assert '<a href="components/g.horn.html"><code>g.' in html
    assert '<a href="components/g.horn.html"><em>Horn</em></a>' in html
    assert "<b>" not in html
    assert "figures/changes/components.svg" in html


def test_a_changed_element_has_a_chip_and_both_versions_side_by_side(site: Path) -> None:
    html = read(site, "components/g.eye.html")
    assert text_of(re.findall(r'<div class="title">.*?</div>', html)[0]) == "Eye changed since HEAD"
    table = re.findall(r"<caption>Changed since HEAD</caption>.*?</table>", html, re.DOTALL)[0]
    rows = [text_of(row) for row in re.findall(r"<tr>(.*?)</tr>", table)]
    assert rows[0] == "What Before (HEAD) Now"
    assert "functionality Looks at five things. Looks at six &lt;b&gt; things." in rows
    assert 'Looks at <span class="removed">five</span> things.' in table
    assert 'Looks at <span class="added">six &lt;b&gt;</span> things.' in table
    assert "tags a b a c" in rows
    assert any(row.startswith("output extra \N{MINUS SIGN} ") for row in rows)
    assert "Changed since" not in read(site, "components/h.still.html")


def test_new_and_renamed_elements_say_so(site: Path) -> None:
    horn = read(site, "components/g.horn.html")
    assert "new" in text_of(re.findall(r'<div class="title">.*?</div>', horn)[0])
    assert "Changed since" not in horn
    arm = read(site, "components/g.arm.html")
    assert "renamed" in text_of(re.findall(r'<div class="title">.*?</div>', arm)[0])
    assert "renamed g.old_arm g.arm" in text_of(re.findall(r"<caption>Changed since.*?</table>", arm, re.DOTALL)[0])


def test_the_tree_and_the_lists_mark_what_changed(site: Path) -> None:
    tree = re.findall(r"<nav id=.navigation.*?</nav>", read(site, "groups/g.html"), re.DOTALL)[0]
    marked = [
        text_of(entry).partition(" (")[0] for entry in re.findall(r"<a [^>]*>.*?</a>", tree) if "mark changed" in entry
    ]
    assert marked[0].startswith("Group")
    assert {"Eye", "Arm", "Horn"} <= set(marked)
    assert not {"Other", "Still", "Brain"} & set(marked)
    rows = [text_of(row) for row in re.findall(r"<tr>(.*?)</tr>", read(site, "components.html"))]
    assert any(row.startswith("Eye changed") for row in rows)
    assert any(row.startswith("Horn new") for row in rows)
    assert any(row.startswith("Brain Thinks") for row in rows)


def test_pictures_mark_what_changed_as_those_of_a_comparison_do(site: Path) -> None:
    overview = read(site, "figures/overview.svg")
    assert "~ Group" in overview
    assert "~ Other" not in overview
    assert "~ changed" in overview
    group = read(site, "figures/groups/g.svg")
    assert "+ Horn" in group
    assert "~ Eye" in group
    assert "→ Arm" in group


def test_without_since_nothing_of_it_is_there(tmp_path: Path) -> None:
    assert make_site(tmp_path).exit_code == 0
    assert not (tmp_path / "site" / "changes.html").exists()
    for name in ("index.html", "components/g.eye.html", "components.html", "figures/overview.svg"):
        html = read(tmp_path / "site", name)
        # The start page says how to see it.
        hint = "What changed</dt><dd><code>archgen site --since REVISION</code>"
        assert (html.count("changed"), html.count(hint)) == ((1, 1) if name == "index.html" else (0, 0))
        assert "Changes" not in html
    assert make_site(tmp_path, "--since", "HEAD").exit_code == 0
    assert "--since REVISION" not in read(tmp_path / "site", "index.html")


def test_a_version_is_named_as_diff_takes_it_with_the_same_words_for_mistakes(tmp_path: Path) -> None:
    result = make_site(tmp_path, "--since", "nonsense")
    root = tmp_path / "robot"
    wrong = CliRunner().invoke(main, ["diff", "nonsense", "-C", str(root)])
    assert (result.exit_code, wrong.exit_code) == (2, 2)
    assert result.output.splitlines()[-1] == wrong.output.splitlines()[-1]
    assert not (tmp_path / "site").exists()
    (tmp_path / "old.yaml").write_text(OLD)
    folder_result = CliRunner().invoke(
        main, ["site", str(root), "--since", str(tmp_path / "old.yaml"), "-o", str(tmp_path / "site")]
    )
    assert folder_result.exit_code == 0
    assert "Horn" in read(tmp_path / "site", "changes.html")


def test_a_project_that_did_not_change_says_so(tmp_path: Path) -> None:
    root = repositories.repository(tmp_path / "robot", {"archgen.yaml": OLD})
    result = CliRunner().invoke(main, ["site", str(root), "--since", "HEAD", "-o", str(tmp_path / "site")])
    assert result.exit_code == 0
    assert "No change of the architecture." in text_of(read(tmp_path / "site", "changes.html"))
    assert "mark changed" not in read(tmp_path / "site", "index.html")


def test_the_page_of_an_interface_tells_what_changed_of_it(tmp_path: Path) -> None:
    old = """\
archgen: 1
partners: {p: {title: Giver}, q: {title: Taker}}
groups:
  g:
    components:
      eye: {owner: p, outputs: {seen: Seen, same: Same}}
      brain: {owner: q, inputs: {a: eye.seen, b: eye.same}}
"""
    root = repositories.repository(tmp_path / "robot", {"archgen.yaml": old})
    (root / "archgen.yaml").write_text(old.replace("seen: Seen", "seen: Heard"))
    result = CliRunner().invoke(main, ["site", str(root), "-o", str(tmp_path / "site"), "--since", "HEAD"])
    assert result.exit_code == 0, result.output
    pages = {path.stem: text_of(path.read_text()) for path in (tmp_path / "site" / "partners").glob("*/*/*.html")}
    changed = [name for name, text in pages.items() if "Changed since HEAD" in text]
    assert sorted(pages) == ["g.eye.same", "g.eye.seen"]
    assert changed == ["g.eye.seen"]
    assert "Seen Heard" in pages["g.eye.seen"]


def test_a_page_tells_what_its_node_does_otherwise_and_what_comes_from_others_otherwise(tmp_path: Path) -> None:
    old = """\
archgen: 1
partners: {p: {title: Giver}, q: {title: Taker}}
types: {Seen: std_msgs/msg/Bool}
groups: {g: {components: {eye: {owner: p, outputs: {seen: Seen, more: Seen}}, brain: {owner: q, inputs: {seen: eye.seen, more: eye.more}}}}}
hosts: {h: {cores: 2}}
nodes:
  eye: {implements: eye, host: h, timing: {rate: 20 Hz, wcet: 1 ms}, publishes: {seen: {topic: /seen, qos: {depth: 2}}}}
  brain: {implements: brain, host: h, timing: {rate: 10 Hz, wcet: 3 ms, core: 1, priority: 80}}
"""
    root = repositories.repository(tmp_path / "robot", {"archgen.yaml": old})
    (root / "archgen.yaml").write_text(old.replace("depth: 2", "depth: 5").replace("20 Hz", "5 Hz"))
    result = CliRunner().invoke(main, ["site", str(root), "-o", str(tmp_path / "site"), "--since", "HEAD"])
    assert result.exit_code == 0, result.output
    pages = {
        name: text_of(read(tmp_path / "site", f"{name}.html"))
        for name in ("components/g.eye", "nodes/eye", "components/g.brain", "nodes/brain")
    }
    home = text_of(read(tmp_path / "site", "index.html"))
    assert re.search(r"What changed \d+ changes? of .*\. All changes since HEAD", home), (
        "the start page said nothing of it"
    )
    for name in ("components/g.eye", "nodes/eye"):
        assert "port seen · qos depth: 2 depth: 5" in pages[name]
        assert "rate 20 Hz 5 Hz" in pages[name], "a node's page says what its component's does"
        assert "What comes to it otherwise" not in pages[name]
    for name in ("components/g.brain", "nodes/brain"):
        words = "What comes to it otherwise since HEAD g.eye.seen from Giver to Taker"
        assert words in pages[name]
        assert "Giver gives seen and more · it is owed QoS offered of Eye · more" in pages[name]
    assert "it owes QoS offered of Eye · more" in pages["nodes/eye"]
    assert "execution up to 3 ms; priority 80; core 1" in pages["components/g.brain"]
