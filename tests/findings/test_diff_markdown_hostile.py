"""Whatever a stranger calls things, a comment keeps its form, and nobody is called by it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.compare import Change, Comparison
from archgen.compare.comparison import BoundaryChange, FigureChange, FigureKey, LoadChange, PartnerBreak, TravelPath
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import Span
from archgen.emit.markdown import comparison_markdown
from archgen.emit.markdown.comment_sentences import escape_inert
from archgen.emit.markdown.comparison_markdown import MAX_COMMENT_SIZE
from archgen.model.project_settings import AcceptedChange
from archgen.timing.figures.timing_values import TimingValue
from archgen.views.changes.comparison_document import ReadingErrors, describe_comparison
from archgen.views.graphs.changes import SMALL_BUDGET, draw_changes
from tests.emit.markdown.test_comparison_markdown import ROBOT, comparison
from tests.findings.hostile_findings import HOSTILE
from tests.findings.rendered import CALLS, inner, shape, tokens, words
from tests.property_sizes import count_examples, try_some

MARKS = "@#!$%~&^*_`<>[]()|\\\"':;/.-+={}\n\t \u200b\u202e\x00a1fW"
PIECES = [
    *(
        "@user ",
        "@org/team",
        "#12",
        "org/repo#3",
        "GH-7",
        "deadbeef01",
        "https://x.io",
        "www.x.io",
        "a@b.io",
        ":+1:",
        ":tada:",
    ),
    *(
        "```\n",
        "~~~",
        "</details>",
        "<details>",
        "<!--",
        "-->",
        "<sub>",
        "</sub>",
        "<img src=x>",
        "![a](b)",
        "[a](b)",
        "<a@b.c>",
    ),
    *(
        "| a | b |",
        "\n\n# h\n",
        "\n- x",
        "\n---\n",
        "&copy;",
        "$`x`$",
        "$$",
        "%%{init}%%",
        '"]',
        "end",
        "\\",
        "\n/close\n",
        "[[x]]",
    ),
]
TEXTS = st.lists(st.one_of(st.sampled_from(PIECES), st.text(MARKS, max_size=6), st.text(max_size=4)), max_size=8).map(
    "".join
)
LINES = {"text", "code_inline", "softbreak", "strong_open", "strong_close", "html_inline"}


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    """Give a comparison in which something of each sort changed."""
    after = ROBOT.replace("wcet: 20 ms", "wcet: 60 ms").replace(
        "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
    )
    return comparison(tmp_path_factory.mktemp("hostile"), ROBOT, after)[0]


_HALF = TimingValue(Fraction(1, 2))
_FIGURES = (
    FigureChange(FigureKey("rate", "n"), _HALF, None),
    FigureChange(FigureKey("hosts"), None, TravelPath(("a",), ("b",), ("c",))),
)


def comment(found: Comparison, text: str) -> str:
    """Write a comment with one text wherever it can hold one."""
    said = f"{text} `{text}` {text}"
    breaks = (PartnerBreak("p", said),)
    claims = (AcceptedChange("x", text, "x", Span("archgen.yaml", 1, 1, 1, 1)),)
    changes = (
        Change("changed", "component", "sensing.camera", key="x", breaks=breaks, claims=claims, text=said),
        Change("added", "component", "display.finder", text=said),
        Change("changed", "view", "v", key="title", text=said),
    )
    finding = Diagnostic("late-chain", said, Span(text or "f", 1, 1, 1, 1), Severity.WARNING)
    note = replace(finding, severity=Severity.NOTE)
    here = _titled(found, text)
    chains = tuple(replace(each, id=text) for each in found.chains)
    here = replace(
        here,
        changes=changes,
        new_findings=(finding, note),
        cured_findings=(finding,),
        silenced_findings=(finding,),
        chains=chains,
        concerned_owners=(text, "q"),
    )
    document = describe_comparison(
        here, text, text, ReadingErrors((finding,), (finding, finding)), draw_changes(here, SMALL_BUDGET)
    )
    return comparison_markdown.write_comparison_markdown(document, text)


def figure_comment(found: Comparison, text: str) -> str:
    """Return a comment in which a text stands wherever figures name something, and nothing else."""
    here = replace(
        _titled(found, text),
        changes=(),
        new_findings=(),
        chains=(),
        concerned_owners=(text, *found.concerned_owners),
        boundaries=(
            BoundaryChange("changed", text, text, (text,), ("sssa",), _FIGURES, frozenset(), (text,)),
            BoundaryChange("added", text, None, ("sssa",), (text,), (), frozenset()),
        ),
        loads=(LoadChange("link", text, None, _HALF, frozenset({text})),),
    )
    return comparison_markdown.write_comparison_markdown(describe_comparison(here, "main", "arm"))


def _titled(found: Comparison, text: str) -> Comparison:
    """Call every group, component, partner and type by a text."""
    known = found.after.architecture
    groups = {name: replace(each, title=text) for name, each in known.groups.items()}
    components = {name: replace(each, title=text) for name, each in known.components.items()}
    outputs = {name: replace(each, type=text) for name, each in known.outputs.items()}
    partners = {name: replace(each, title=text) for name, each in known.partners.items()}
    known = replace(known, groups=groups, components=components, outputs=outputs, partners=partners)
    return replace(found, after=replace(found.after, architecture=known))


def check(found: Comparison, text: str) -> None:
    """Hold a comment with a hostile text against one with a harmless text."""
    for write in (comment, figure_comment):
        made = write(found, text)
        parsed = tokens(made)
        assert shape(parsed) == shape(tokens(write(found, "word")))
        assert {token.type for token in inner(parsed)} <= LINES
        assert {token.content for token in inner(parsed) if token.type == "html_inline"} <= {"<sub>", "</sub>"}
        # The alert above what breaks is ours, and stands there once.
        text_words = words(parsed).replace("[!CAUTION]", "", 1)
        assert not CALLS.search(text_words), CALLS.search(text_words)
        assert len(made) <= MAX_COMMENT_SIZE


@given(TEXTS)
@settings(max_examples=count_examples(150), deadline=None)
def test_no_text_changes_the_form_or_calls_anybody(sound: Comparison, text: str) -> None:
    check(sound, text)


@pytest.mark.parametrize(
    "text", try_some([*PIECES, *(text for name, text in HOSTILE.items() if name != "surrogates")], 16)
)
def test_each_trick(sound: Comparison, text: str) -> None:
    check(sound, text)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("@user", "@\u200buser"),
        ("ask @org/team now", "ask @\u200borg/team now"),
        ("#12 and org/repo#3", "#\u200b12 and org/repo#\u200b3"),
        ("GH-7", "GH\u200b-7"),
        ("at deadbeef01", "at deadbe\u200bef01"),
        ("https://x.io/a", "https:\u200b//x\u200b.io/a"),
        ("mail a@b.io", "mail a@\u200bb\u200b.io"),
        (":tada:", ":\u200btada:"),
        ("`code` *b* _i_ <b>", "`code` *b* _i_ <b>"),
        ("a | b", "a | b"),
        ("5 ms, 30 %, Test & Co", "5 ms, 30 %, Test & Co"),
    ],
)
def test_plain_text_reads_as_it_was_and_calls_nobody(text: str, kept: str) -> None:
    (inline,) = [token for token in tokens(escape_inert(text)) if token.type == "inline"]
    assert "".join(token.content for token in inline.children or ()) == kept
    assert {token.type for token in inline.children or ()} == {"text"}


def test_the_judge_sees_what_calls() -> None:
    """Without the escape the same texts are found: the test above can fail."""
    for text in PIECES[:11]:
        assert CALLS.search(words(tokens(f"said {text} here"))) or "link_open" in {
            t.type for t in inner(tokens(text))
        }, text
