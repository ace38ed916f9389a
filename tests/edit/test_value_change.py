"""Values changed in a text: what is written there, whatever its form, and nothing else."""

from __future__ import annotations

import pytest

from archgen.edit.adopted_remedies import ValueChange, change_values
from archgen.edit.element_edit import CannotInsertError

TIMING = ("nodes", "a", "timing")
SET = ValueChange(TIMING, "priority", 7)
TRIGGER = ValueChange(TIMING, "trigger", ["scan"], "rate")
OWN_HOST = ValueChange(("nodes", "a"), "host", "pc", "container")
OUT = ValueChange(("nodes", "a"), "container", None)


@pytest.mark.parametrize(
    ("changes", "before", "after"),
    [
        ([SET], "nodes: {a: {timing: {rate: 5 Hz}}}\n", "nodes: {a: {timing: {rate: 5 Hz, priority: 7}}}\n"),
        ([SET], "nodes: {a: {timing: {rate: 5 Hz,}}}\n", "nodes: {a: {timing: {rate: 5 Hz, priority: 7}}}\n"),
        ([SET], "nodes: {a: {timing: {}}}\n", "nodes: {a: {timing: {priority: 7}}}\n"),
        ([SET], "nodes: {a: {is: x}}\n", "nodes: {a: {is: x, timing: {priority: 7}}}\n"),
        ([SET], "nodes: {a: {timing: {priority: 3}}} # why\n", "nodes: {a: {timing: {priority: 7}}} # why\n"),
        ([SET], 'nodes: {a: {timing: {"priority": "3"}}}\n', 'nodes: {a: {timing: {"priority": 7}}}\n'),
        ([SET], "nodes:\n  a:\n    is: x  # this\n", "nodes:\n  a:\n    is: x  # this\n    timing: {priority: 7}\n"),
        ([SET], "nodes:\n  a:\n    is: x", "nodes:\n  a:\n    is: x\n    timing: {priority: 7}"),
        ([SET], "nodes:\r\n  a:\r\n    is: x\r\n", "nodes:\r\n  a:\r\n    is: x\r\n    timing: {priority: 7}\r\n"),
        (
            [SET],
            "nodes:\n  a:\n    timing:\n      rate: 5 Hz # slow\n      inputs:\n        scan: {wcet: 1 ms}\n  b: {}\n",
            "nodes:\n  a:\n    timing:\n      rate: 5 Hz # slow\n      priority: 7\n      inputs:\n        scan: {wcet: 1 ms}\n  b: {}\n",
        ),
        (
            [SET],
            "nodes:\n  a:\n    timing:\n      inputs:\n        scan: {wcet: 1 ms}\n",
            "nodes:\n  a:\n    timing:\n      priority: 7\n      inputs:\n        scan: {wcet: 1 ms}\n",
        ),
        (
            [TRIGGER, SET, ValueChange(TIMING, "every", 2)],
            "nodes: {a: {timing: {rate: 5 Hz, wcet: 1 ms}}}\n",
            "nodes: {a: {timing: {trigger: [scan], wcet: 1 ms, priority: 7, every: 2}}}\n",
        ),
        (
            [TRIGGER, SET],
            "nodes: {a: {timing: {wcet: 1 ms, rate: 5 Hz}}}\n",
            "nodes: {a: {timing: {wcet: 1 ms, trigger: [scan], priority: 7}}}\n",
        ),
        ([TRIGGER], "nodes:\n a:\n  timing:\n   rate: 5 Hz # x\n", "nodes:\n a:\n  timing:\n   trigger: [scan] # x\n"),
        ([OWN_HOST], "nodes: {a: {container: b, is: c}}\n", "nodes: {a: {host: pc, is: c}}\n"),
        ([OUT], "nodes: {a: {is: c, container: b, host: d}}\n", "nodes: {a: {is: c, host: d}}\n"),
        ([OUT], "nodes: {a: {is: c, container: b}}\n", "nodes: {a: {is: c}}\n"),
        ([OUT], "nodes: {a: {container: b}}\n", "nodes: {a: {}}\n"),
        ([OUT], "nodes:\n  a:\n    container: b # it\n    is: c\n", "nodes:\n  a:\n    is: c\n"),
        ([OUT, SET], "nodes: {a: {is: c, container: b}}\n", "nodes: {a: {is: c, timing: {priority: 7}}}\n"),
    ],
)
def test_only_these_values_change(changes: list[ValueChange], before: str, after: str) -> None:
    assert change_values("f.yaml", before, changes) == after


@pytest.mark.parametrize(
    ("change", "text", "message"),
    [
        (SET, "nodes: {a: drive.a}\n", "`a` is not a mapping that is written out"),
        (SET, "nodes: {a: {timing: }}\n", "`timing` is not a mapping that is written out"),
        (SET, "x: &t {rate: 5 Hz}\nnodes: {a: {timing: *t}}\n", "`timing` is written once and used here by its anchor"),
        (
            SET,
            "p: &p 3\nnodes: {a: {timing: {priority: *p}}}\n",
            "`priority` is not written as a plain value on one line",
        ),
        (SET, "nodes: {a: {timing: &t {rate: 5 Hz}}, b: {timing: *t}}\n", "more than these values would change"),
        (OUT, "nodes:\n  a:\n    is: c\n    container: >\n      b\n", "`container` is written on several lines"),
        (SET, "nodes: {a: \n", "cannot be parsed"),
        (SET, "nodes: {a: {timing: {rate: 5 Hz}}}\r# old\n", "line breaks"),
    ],
)
def test_what_cannot_be_changed_alone_is_refused(change: ValueChange, text: str, message: str) -> None:
    with pytest.raises(CannotInsertError) as refused:
        change_values("f.yaml", text, [change])
    assert message in str(refused.value)
