"""Python of the user's own is read as what it defines and uses; nothing of it is run."""

from __future__ import annotations

import pytest

from archgen.emit.workspace.python_code import UnreadableCodeError, names_message, read_python_code

CODE = b"""\
import std_msgs.msg as m
from std_srvs.srv import Trigger as Go
from .other import Base

class Helper:
    def help(self, text): ...

class Guard(Base):
    def __init__(self, parent: 'ParentNode'):
        self.parent = parent
    def receive_a(self, message: m.Bool): ...
    def receive_b(self, message: 'std_msgs.msg.UInt8'): ...
    receive_c = receive_b
    async def serve_go(self, request: Go.Request, response): ...
    def work(self):
        robot = self.parent
        sent = m.Bool(data=True)
        robot.publish_a(sent)
        sent_twice = m.Bool()
        sent_twice = 3
        robot.publish_b(sent_twice)
        self.parent.call_go(Go.Request())
        print(self.parent.parameters['depth'])
        other.publish_c(1)
        getattr(self.parent, f'publish_{robot}')(1)

def receive_d(message: m.Bool): ...
"""


def test_what_is_defined_and_used() -> None:
    code = read_python_code(CODE)
    assert (code.class_name, code.class_line, code.foreign_base) == ("Guard", 8, "Base")
    assert {name: method.message for name, method in code.methods.items() if name.startswith(("receive", "serve"))} == {
        "receive_a": ("std_msgs", "Bool"),
        "receive_b": ("std_msgs", "UInt8"),
        "receive_c": None,
        "serve_go": ("std_srvs", "Trigger"),
        "receive_d": ("std_msgs", "Bool"),
    }
    assert [(use.name, use.line, use.message) for use in code.uses if use.name != "parameters"] == [
        ("publish_a", 18, ("std_msgs", "Bool")),
        ("publish_b", 21, None),
        ("call_go", 22, ("std_srvs", "Trigger")),
    ]
    assert [(text.name, text.reader) for text in code.texts] == [("depth", "[]")]
    assert [(each.line, each.name) for each in code.computed] == [(25, "getattr(self.parent, f'publish_{robot}')")]


def test_a_digest_changes_with_the_function_alone() -> None:
    def digest(text: bytes) -> str:
        return read_python_code(text).methods["work"].digest

    assert digest(CODE) == digest(b"# More.\n" + CODE.replace(b"def help", b"def aid"))
    assert digest(CODE) != digest(CODE.replace(b"sent_twice = 3", b"sent_twice = 4"))


@pytest.mark.parametrize(
    ("code", "line", "words"),
    [
        (b"x = 1\ndef y(:\n", 2, "it is no Python"),
        (b"x\0", 1, "it is no"),
        (b"# coding: nothing\n", 1, "it is no"),
        (b"\xff\xfe", 1, "it is no"),
        (b"-" * 100_000 + b"1", 1, "it is nested too deeply"),
        (b"#" * 2_000_001, 1, "it has more than 2 MB"),
    ],
)
def test_what_cannot_be_read_is_told(code: bytes, line: int, words: str) -> None:
    with pytest.raises(UnreadableCodeError, match=words) as refused:
        read_python_code(code)
    assert refused.value.line == line


@pytest.mark.parametrize(
    ("written", "message", "is_same"),
    [
        (("std_msgs", "Bool"), "std_msgs/msg/Bool", True),
        (("std_msgs", "Bool"), "other_msgs/msg/Bool", False),
        (("std_srvs", "TriggerRequest"), "std_srvs/srv/Trigger", True),
        (("a_msgs", "LastGoal"), "a_msgs/msg/LastGoal", True),
        (("a_msgs", "Goal"), "a_msgs/msg/LastGoal", False),
    ],
)
def test_classes_of_a_message(written: tuple[str, str], message: str, is_same: bool) -> None:  # noqa: FBT001 - a column
    assert names_message(written, message) == is_same
