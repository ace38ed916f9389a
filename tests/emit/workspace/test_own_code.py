"""Own code against what is generated around it; changes of a model from end to end: tests/plugins/ros_code/test_own_code.py."""

from __future__ import annotations

import pytest

from archgen.emit.workspace.own_code import CodeReport, judge_own_code, read_contract
from archgen.products.own_code_patch import rename_likely

OLD = read_contract(["receive_a=x.a:p/msg/A"], ["publish_b=x.b:p/msg/B", "'gain'=:double"])


def judge(code: str, expects: str, offers: str, recorded: dict[str, str], path: str = "own.py") -> CodeReport:
    return judge_own_code(path, code.encode(), read_contract(expects.split(), offers.split()), recorded)


def tell(report: CodeReport) -> list[str]:
    return [f"{each.line}: {each.message}" for each in report.findings]


CODE = """\
class X:
    def __init__(self, node): self.node = node
    def receive_a(self, message): self.node.publish_b(message)
"""


def test_what_was_lost_is_remembered_until_it_is_mended() -> None:
    recorded = judge_own_code("own.py", CODE.encode(), OLD, {}).meanings
    assert set(recorded) == {"receive_a", "publish_b", "'gain'"}
    for _ in range(2):
        report = judge(CODE, "receive_c=x.c:p/msg/A", "publish_d=x.d:p/msg/B", dict(recorded))
        assert tell(report) == [
            "3: nobody calls `receive_a` any more; it is most likely `receive_c` now (`x.c`, not `x.a`), which is lacking",
            "3: the node has no `publish_b` any more; it is most likely `publish_d` now",
        ]
        recorded = report.meanings
        new = {name for name, meaning in recorded.items() if meaning.startswith("+")}
        assert (set(recorded) - new, new) == ({"receive_a", "publish_b"}, {"receive_c", "publish_d"})
    mended = judge(
        CODE.replace("_a", "_c").replace("_b", "_d"), "receive_c=x.c:p/msg/A", "publish_d=x.d:p/msg/B", dict(recorded)
    )
    assert tell(mended) == []
    assert set(mended.meanings) == {"receive_c", "publish_d"}


@pytest.mark.parametrize("path", ["own.py", "own.cpp"])
def test_what_is_mended_and_renamed_again_between_two_runs_is_known_again(path: str) -> None:
    code = CODE if path.endswith(".py") else "void receive_a() { publish_b(1); }\n"
    recorded = dict(judge_own_code(path, code.encode(), OLD, {}).meanings)
    for _ in range(2):
        report = judge(code, "receive_a=x.a:p/msg/A", "publish_d=x.d:p/msg/B publish_o=x.o:p/msg/O", recorded, path)
        recorded = dict(report.meanings)
        assert [each.new_name for each in report.findings] == ["publish_d"]
    # Somebody mends it, and the model has another name before archgen runs again.
    code = code.replace("publish_b", "publish_d")
    report = judge(code, "receive_a=x.a:p/msg/A", "publish_e=x.e:p/msg/B publish_o=x.o:p/msg/O", recorded, path)
    assert [(each.old_name, each.new_name) for each in report.findings] == [("publish_d", "publish_e")]
    mended = judge(code, "receive_a=x.a:p/msg/A", "publish_d=x.d:p/msg/B publish_o=x.o:p/msg/O", recorded, path)
    assert not mended.findings
    assert not any(meaning.startswith("+") for meaning in mended.meanings.values())


def test_two_that_may_be_meant_are_no_guess() -> None:
    recorded = judge_own_code("own.py", CODE.encode(), OLD, {}).meanings
    report = judge(CODE, "receive_a=x.a:p/msg/A", "publish_one=x.o:p/msg/B publish_two=x.t:p/msg/B", dict(recorded))
    assert tell(report) == ["3: the node has no `publish_b` any more"]


def test_a_method_that_own_code_calls_itself_is_no_orphan() -> None:
    recorded = judge_own_code("own.py", CODE.encode(), OLD, {}).meanings
    own = CODE + "    def more(self): self.receive_a(1)\n"
    assert tell(judge(own, "", "publish_b=x.b:p/msg/B", dict(recorded))) == []


def test_words_of_other_languages_stand_outside_of_comments_and_texts() -> None:
    code = '// publish_b\n/* publish_b */ "publish_b"\nvoid receive_a() {\n  publish_b(1);\n}\n'
    recorded = judge_own_code("own.cpp", code.encode(), OLD, {}).meanings
    assert tell(judge(code, "receive_a=x.a:p/msg/A", "publish_b=x.b", dict(recorded), "own.cpp")) == []
    report = judge(code, "receive_a=x.a:p/msg/A receive_z=x.z", "publish_d=x.d:p/msg/B", dict(recorded), "own.cpp")
    assert tell(report) == [
        "4: `publish_b` is nothing that is generated any more; it is most likely `publish_d` now",
        "0: it lacks receive_z",
    ]
    renamed = code.replace("  publish_b(1)", "  publish_d(1)")
    assert rename_likely("own.cpp", code.encode(), report.findings).decode() == renamed


CPP = """\
// p::msg::A, read_parameters().gain
void Own::receive_a(
  p::msg::A::ConstSharedPtr message)
{
  const auto values = node_.read_parameters();
  use(values.gain, message->gain);
  p::msg::B other;
}
"""


def test_messages_and_parameters_that_cpp_names_are_told() -> None:
    recorded = judge_own_code("own.cpp", CPP.encode(), OLD, {}).meanings
    same = "publish_b=x.b:p/msg/B"
    for _ in range(2):
        report = judge(CPP, "receive_a=x.a:p/msg/Z", f"{same} 'gains'=:double", dict(recorded), "own.cpp")
        assert tell(report) == [
            "2: `receive_a` has `p/msg/Z` now, and not `p/msg/A`",
            "6: the node has no parameter `gain` any more; it is most likely `gains` now",
        ]
        recorded = report.meanings
    mended = CPP.replace("p::msg::A::Const", "p::msg::Z::Const").replace("values.gain", "values.gains")
    assert tell(judge(mended, "receive_a=x.a:p/msg/Z", f"{same} 'gains'=:double", dict(recorded), "own.cpp")) == []
    asked = CPP.replace("values.gain", 'node_.get_parameter("gain")')
    (told,) = tell(judge(asked, "receive_a=x.a:p/msg/A", same, {"'gain'": ":double"}, "own.cpp"))
    assert told == "6: the node has no parameter `gain` any more"
    # Another port still has the message.
    assert (
        tell(judge(CPP, "", "publish_b=x.b:p/msg/C publish_c=x.c:p/msg/B", {"publish_b": "x.b:p/msg/B"}, "own.cpp"))
        == []
    )
    (told,) = tell(judge(CPP, "", "publish_b=x.b:p/msg/C", {"publish_b": "x.b:p/msg/B"}, "own.cpp"))
    assert told == "7: `publish_b` has `p/msg/C` now, and not `p/msg/B`"


def test_a_hook_that_nobody_calls_any_more_is_told() -> None:
    code = "class X:\n    def __init__(self, node): self.node = node\n    def on_activate(self): pass\n    def on_parameters(self, values): pass\n"
    recorded = judge(code, "", "on_activate on_parameters", {}).meanings
    assert tell(judge(code, "", "", dict(recorded))) == [
        "3: nobody calls `on_activate` any more: the node has no life cycle",
        "4: nobody calls `on_parameters` any more: the node has no parameters",
    ]
