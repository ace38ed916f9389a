"""What is hard to write in Java and Python: odd names, hostile texts, calls, an empty architecture, and many components."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import hostile
from tests.plugins.middlewares.simulation.simulated_workspaces import build_java, generate, run_java, run_python

pytestmark = pytest.mark.build

ODD_NAMES = r'''
archgen: 1
project: {id: class, title: 'T \u000a */ T'}
rules: {missing-detail: off}
types:
  String: {fields: {wait: bool, to_string: string, new: "float64[2]", text: string, runtime: int64, empty: bool, equals: int8, list: "string[]"}}
  Object: {values: ["NULL", DEFAULT]}
  Component: {fields: {number: {type: String}, object: "Object[<=2]"}}
  Ask: {request: {why: String}, response: {class: string}}
  Go: {request: {to: int64}, response: {done: bool}, feedback: {share: float64}}
component_types:
  string:
    functionality: '*/ class X {} /* {@link Y} <b> &amp; \u0022; """ + x'
    inputs: {new: String, inputs: Component, fire: Text}
    outputs: {new: String, behaviour: Object, parameters: Component, timing: Text}
    parameters: {int: {value: 5, range: [0, 10]}, class: {value: '"; }', choices: ['"; }', 'x\u000a']}, unset: {type: string}}
groups:
  data: {components: {types: {functionality: F, inputs: {}, outputs: {geometry_msgs: geometry_msgs/Pose}}}}
  types: {components: {list: {is: string}}}
  import:
    components:
      while: {is: string, inputs: {new: {from: [override.new]}, inputs: {from: override.parameters}}, outputs: {new: {type: String, description: 'a */ b \u002a/ "'}}}
      override: {is: string}
      thread: {functionality: F, inputs: {ask: math.ask, go: math.go, x: {type: Text, external: e}}, outputs: {}, timing: {behaviour: event}}
      math: {functionality: F, inputs: {}, outputs: {ask: Ask, go: Go}}
'''


def test_odd_names_and_texts(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(ODD_NAMES.lstrip(), "utf-8")
    assert generate(tmp_path, tmp_path / "ws") == []
    behaviour = tmp_path / "ws" / "java" / "src" / "class_" / "import_"
    thread = behaviour / "ThreadComponentBehaviour.java"
    thread.write_text(
        thread.read_text("utf-8").replace(
            "        // F.",
            """\
        String told = component.ask.call(new class_.data.class_msgs.AskRequest(class_.data.class_msgs.StringMessage.empty())).class_();
        component.go.call(class_.data.class_msgs.GoGoal.empty().withTo(7), step -> component.go.call(class_.data.class_msgs.GoGoal.empty()));
        System.err.println(told);""",
        ),
        "utf-8",
    )
    answers = behaviour / "MathComponentBehaviour.java"
    answers.write_text(
        answers.read_text("utf-8")
        .replace("AskResponse.empty()", 'AskResponse.empty().withClass_(request.why().toString_() + "!")')
        .replace(
            "return GoResult.empty()",
            "if (request.to() == 7) {\n            feedback.accept(new class_.data.class_msgs.GoFeedback(0.5));\n        }\n        return new GoResult(request.to() == 7)",
        ),
        "utf-8",
    )
    build_java(tmp_path / "ws")
    assert run_java(tmp_path / "ws", "class_.ArchitectureTest") == (0, "3 tests passed\n", "")
    python = tmp_path / "ws" / "python" / "class_simulation" / "import_"
    thread = python / "thread_behaviour.py"
    thread.write_text(
        """\
from ..data import class_msgs


class ThreadComponentBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        told = self.component.ask.call(class_msgs.AskRequest())
        self.component.go.call(class_msgs.GoGoal(to=7), lambda step: self.component.go.call(class_msgs.GoGoal()))
""",
        "utf-8",
    )
    answers = python / "math_behaviour.py"
    answers.write_text(
        answers.read_text("utf-8")
        .replace("class_msgs_data.AskResponse()", 'class_msgs_data.AskResponse(class_=request.why.to_string + "!")')
        .replace(
            "return class_msgs_data.GoResult()",
            "if request.to == 7:\n            feedback(class_msgs_data.GoFeedback(share=0.5))\n        return class_msgs_data.GoResult(done=request.to == 7)",
        ),
        "utf-8",
    )
    assert run_python(tmp_path / "ws", "unittest", "-q", "class_simulation.test_architecture")[0] == 0
    (tmp_path / "scenario.txt").write_text(
        '5ms < import.thread.x {"data": "go"}\n6ms > import.override.new {"new": [1, 2], "list": ["\\ud800"]}\n',
        "utf-8",
    )
    java = run_java(tmp_path / "ws", "class_.Main", str(tmp_path / "scenario.txt"))
    traced = run_python(tmp_path / "ws", "class_simulation", str(tmp_path / "scenario.txt"))
    assert (java[0], traced[0]) == (0, 0), (java[2], traced[2])
    assert java[1].splitlines() == traced[1].splitlines()
    assert java[1].splitlines()[1:10] == [
        '5000000 ? import.thread.ask {"why":{"wait":false,"to_string":"","new":[0.0,0.0],"text":"","runtime":0,"empty":false,"equals":0,"list":[]}}',
        '5000000 ! import.thread.ask {"class":"!"}',
        '5000000 ? import.thread.go {"to":7}',
        '5000000 ~ import.thread.go {"share":0.5}',
        '5000000 ? import.thread.go {"to":0}',
        '5000000 ! import.thread.go {"done":false}',
        '5000000 ! import.thread.go {"done":true}',
        '6000000 > import.override.new {"wait":false,"to_string":"","new":[1.0,2.0],"text":"","runtime":0,"empty":false,"equals":0,"list":["\\ud800"]}',
        '6000000 < import.while.new {"wait":false,"to_string":"","new":[1.0,2.0],"text":"","runtime":0,"empty":false,"equals":0,"list":["\\ud800"]}',
    ]


@pytest.mark.parametrize("attack", list(hostile.TEXTS))
def test_hostile_texts_compile(tmp_path: Path, attack: str) -> None:
    (tmp_path / "archgen.yaml").write_text(hostile.written(hostile.project(hostile.TEXTS[attack])), "utf-8")
    generate(tmp_path, tmp_path / "ws", backends=("java",))
    build_java(tmp_path / "ws")


def test_the_type_of_a_port_that_is_left_out_is_not_imported(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: p}
types: {T: {message: p_msgs/msg/T, fields: {x: {type: int8}}}, U: {message: q_msgs/msg/U, fields: {x: {type: int8}}}}
groups: {g: {components: {a: {outputs: {t: T, T: U}}}}}
"""
    (tmp_path / "archgen.yaml").write_text(text, "utf-8")
    generate(tmp_path, tmp_path / "ws", backends=("python_simulation",))
    (path,) = (tmp_path / "ws").rglob("g/a.py")
    code = path.read_text("utf-8")
    assert "import p_msgs as" in code
    assert "q_msgs" not in code


def test_nothing_at_all(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\nproject: {id: nothing}\n", "utf-8")
    generate(tmp_path, tmp_path / "ws")
    build_java(tmp_path / "ws")
    assert run_java(tmp_path / "ws", "nothing.ArchitectureTest") == (0, "3 tests passed\n", "")
    assert run_java(tmp_path / "ws", "nothing.Main") == (0, "", "") == run_python(tmp_path / "ws", "nothing_simulation")
    assert run_python(tmp_path / "ws", "unittest", "-q", "nothing_simulation.test_architecture")[0] == 0


def test_a_thousand_components(tmp_path: Path) -> None:
    components = [
        f"c{n}: {{functionality: F, inputs: {{i: [c{(n * 7 + 1) % 1000}.o, c{(n * 3 + 2) % 1000}.o]}}, outputs: {{o: T}}, parameters: {{gain: {n}.5, name: n{n}}}}}"
        for n in range(1000)
    ]
    text = "archgen: 1\nproject: {id: many}\nrules: {missing-detail: off}\ntypes: {T: }\ngroups: {g: {components: {\n"
    (tmp_path / "archgen.yaml").write_text(text + ",\n".join(components) + "}}}\n", "utf-8")
    generate(tmp_path, tmp_path / "ws", backends=("java",))
    build_java(tmp_path / "ws")
    assert run_java(tmp_path / "ws", "many.ArchitectureTest") == (0, "3 tests passed\n", "")
