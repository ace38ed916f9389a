"""Small inputs that ask for far more time or memory than they have bytes: of each reader of foreign files, and of the language.

A bomb is a verb and its files. Each is so large that a reader which follows it without a bound takes minutes or gigabytes.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.workbooks import make_document, make_workbook

Files = Mapping[str, str | bytes]
PROJECT = "archgen: 1\nproject: {id: x}\n"
LEVELS = 60
"""How often something doubles: 2 to the power of 60 has no end."""


@dataclass(frozen=True)
class Bomb:
    """What is called, with which files in the current folder."""

    name: str
    words: str
    """The words of the verb."""
    make_files: Callable[[], Files]
    said: str = ""
    """A part of what is said of it, where it must say something."""
    is_quick: bool = False
    """Whether it is tried each time, and not only with the slow tests."""


# --- launch files


def write_launch(*lines: str, head: str = "", actions: str = "s") -> str:
    """Write a launch file in Python whose function holds these lines."""
    body = "".join(f"    {line}\n" for line in lines)
    return (
        "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.substitutions import *\n"
        f"from launch_ros.actions import Node\n{head}\n"
        f"def generate_launch_description():\n{body}    return LaunchDescription({actions})\n"
    )


NODE = "Node(package='a', executable='b', name='first')"


def _double_in_python(line: str, start: str = f"s = [{NODE}]", levels: int = LEVELS) -> Callable[[], Files]:
    return lambda: {"x.launch.py": write_launch(start, *[line] * levels)}


def _python(*lines: str, head: str = "", actions: str = "s") -> Callable[[], Files]:
    return lambda: {"x.launch.py": write_launch(*lines, head=head, actions=actions)}


def _wrap_in_launch(text: str) -> str:
    return f"<launch>{text}</launch>"


def _include_each_other(count: int, times: int) -> dict[str, str]:
    """Write launch files of which each includes the next one several times."""
    last = f"f{count}.launch.xml"
    files = {
        f"f{number}.launch.xml": _wrap_in_launch(f'<include file="$(dirname)/f{number + 1}.launch.xml"/>' * times)
        for number in range(count)
    }
    return {**files, last: _wrap_in_launch('<node pkg="a" exec="b"/>')}


def _nest_arguments(levels: int, word: str = "var") -> str:
    """Write arguments of which each is the one before twice."""
    lines = ['<arg name="a0" default="xx"/>']
    lines += [
        f'<arg name="a{number}" default="$({word} a{number - 1})$({word} a{number - 1})"/>'
        for number in range(1, levels)
    ]
    kind = "exec" if word == "var" else "type"
    return _wrap_in_launch("".join(lines) + f'<node pkg="a" {kind}="b" name="$({word} a{levels - 1})"/>')


def _double_aliases(levels: int = 40) -> str:
    lines = ["a0: &a0 [x, x]"]
    lines += [f"a{number}: &a{number} [*a{number - 1}, *a{number - 1}]" for number in range(1, levels)]
    return "\n".join(lines) + "\n"


LAUNCH = "import launch x.launch.py -o new"
XML_LAUNCH = "import launch x.launch.xml -o new"
# fmt: off
PYTHON_BOMBS = (
    Bomb("stars in a list", LAUNCH, _double_in_python("s = [*s, *s]")),
    Bomb("a list added to itself", LAUNCH, _double_in_python("s += s")),
    Bomb("a sum of lists", LAUNCH, _double_in_python("s = s + s")),
    Bomb("stars in a call", LAUNCH, _double_in_python("s = GroupAction(*s, *s)")),
    Bomb("a text filled in twice", LAUNCH, _double_in_python("s = '{}{}'.format(s, s)", "s = 'xx'")),
    Bomb("a text with each letter replaced", LAUNCH, _double_in_python("s = s.replace('x', 'xx')", "s = 'xx'")),
    Bomb("paths joined", LAUNCH, _double_in_python("s = os.path.join(s, s)", "s = 'xx'"), is_quick=True),
    Bomb("a power of a power", LAUNCH, _python("s = 9 ** 9 ** 9 ** 9", "s = 1 << 10**12", "s = 10**15 * 10**15")),
    Bomb("a substitution of itself", LAUNCH, _double_in_python("s = PathJoinSubstitution([s, s])", "s = LaunchConfiguration('x')")),
    Bomb("a list of itself twice", LAUNCH, _double_in_python("s = [s, s]")),
    Bomb("a mapping of itself", LAUNCH, _double_in_python("s = {'a': s, 'b': s}", "s = {'a': 1}")),
    Bomb("groups of one group", LAUNCH, _double_in_python("s = GroupAction([s, s])", f"s = {NODE}"), "x.launch.py:"),
    Bomb("groups of one empty group", LAUNCH, _double_in_python("s = GroupAction([s, s])", "s = GroupAction([])"), "x.launch.py:"),
    Bomb("functions that call one another twice", LAUNCH, lambda: {"x.launch.py": write_launch("s = [f18()]", head=f"def f0():\n    return [{NODE}]\n" + "".join(f"def f{n}():\n    return f{n - 1}() + f{n - 1}()\n" for n in range(1, 19)))}),
    Bomb("functions at the launch that return themselves", LAUNCH, _python("s = [OpaqueFunction(function=f)]", head="def f(context):\n    return [OpaqueFunction(function=f), OpaqueFunction(function=f)]\n")),
    Bomb("loops in loops", LAUNCH, _python("s = []", *[f"{'    ' * n}for i{n} in range(1000):" for n in range(8)], f"{'    ' * 8}s.append({NODE})")),
    Bomb("a loop without end", LAUNCH, _python("s = []", "while True:", f"    s.append({NODE})")),
    Bomb("comprehensions in comprehensions", LAUNCH, _python(f"s = [{NODE} for a in range(1000) for b in range(1000) for c in range(1000)]")),
    Bomb("long lists kept by many names", LAUNCH, _python("s = list(range(1000)) + list(range(1000)) + list(range(1000))", "k = [[*s] for i in range(1000)]", "k = [[[*s] for i in range(1000)] for j in range(1000)]")),
    Bomb("slices of a long text", LAUNCH, _python("s = 'x'", *["s = s + s"] * 14, "k = [[s[i:] for i in range(1000)] for j in range(1000)]", actions="[]")),
    Bomb("copies of mappings", LAUNCH, _python("s = {str(i): i for i in range(1000)}", "k = [[{**s} for i in range(1000)] for j in range(1000)]", actions="[]")),
    Bomb("pairs of long lists", LAUNCH, _python("s = list(range(1000))", "k = [[list(enumerate(s)) for i in range(1000)] for j in range(1000)]", "k = [[list(zip(s, s, s, s)) for i in range(1000)] for j in range(1000)]", actions="[]")),
    Bomb("splits of a long text", LAUNCH, _python("s = 'x '", *["s = s + s"] * 13, "k = [[s.split(' ') for i in range(1000)] for j in range(1000)]", actions="[]")),
    Bomb("comparisons of long lists", LAUNCH, _python("s = [i for i in range(1000)] + [i for i in range(1000)]", "t = [i for i in s]", "k = [1 for i in range(1000) for j in range(1000) if s == t and 1 in s and 5000 not in s]", actions="[]")),
    Bomb("comparisons of lists in lists", LAUNCH, _python("s = [1]", "t = [1]", *["s = [s, s]", "t = [t, t]"] * LEVELS, "k = s == t", "m = [s] == [t]", actions="[]")),
    Bomb("conditions in a row", LAUNCH, _python("s = []", *[line for n in range(3000) for line in (f"if LaunchConfiguration('a{n}').perform(c):", f"    s.append({NODE})")])),
    Bomb("conditions over long lists", LAUNCH, _python(*[f"l{n} = [i for i in range(1000)]" for n in range(200)], *[line for n in range(2000) for line in (f"if unknown({n}):", f"    l{n % 200}.append({n})")], actions="[]")),
    Bomb("a node with many parameters", LAUNCH, _python("p = {str(i): i for i in range(1000)}", *["p = {'a': p, 'b': p}"] * 4, f"s = [{NODE[:-1]}, parameters=[p] * 1 + [p, p, p]) for i in range(1000)]")),
    Bomb("a node started many times", LAUNCH, _python(f"n = {NODE}", "s = []", *["s += [n] * 1 + [n, n, n, n, n, n, n, n]"] * 500, "s = [GroupAction(s) for i in range(1000)]")),
    Bomb("unread actions many times", LAUNCH, _python("s = [unknown(i) for i in range(1000)]", "s = [GroupAction(s) for i in range(1000)]", "s = [GroupAction(s) for i in range(1000)]")),
    Bomb("a long line", LAUNCH, lambda: {"x.launch.py": write_launch("s = [" + ", ".join(["u()"] * 60000) + "]")}),
    Bomb("modules that import one another", LAUNCH, lambda: {"x.launch.py": write_launch("s = []", head="import m0"), **{f"m{n}.py": f"import m{n + 1}\nfrom m{n + 1} import *\nimport m{n // 2}\n" for n in range(800)}}),
    Bomb("modules that each take all steps", LAUNCH, lambda: {"x.launch.py": write_launch("s = []", head="".join(f"import m{n}\n" for n in range(60))), **{f"m{n}.py": "for i in range(1000):\n    for j in range(1000):\n        for k in range(1000):\n            x = i + j\n" for n in range(60)}}),
)
# fmt: on
# fmt: off
XML_LAUNCH_BOMBS = (
    Bomb("includes by the hundred", "import launch f0.launch.xml -o new", lambda: _include_each_other(20, 8), "f"),
    Bomb("includes of a large file", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch('<include file="$(dirname)/y.launch.xml"/>' * 5000), "y.launch.xml": _wrap_in_launch('<node pkg="a" exec="b"/>' * 20000)}),
    Bomb("arguments of arguments", XML_LAUNCH, lambda: {"x.launch.xml": _nest_arguments(LEVELS)}),
    Bomb("substitutions in substitutions", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch('<node pkg="a" exec="' + "$(var " * 20000 + ")" * 20000 + '"/>' * 1)}),
    Bomb("expressions in expressions", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f"""<node pkg="a" exec="b" if="$(eval '{'(' * 100}1{')' * 100} + {'9' * 500} ** 9 ** 9')"/>""" for _ in range(1000)))}),
    Bomb("expressions that double a text", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch('<let name="a0" value="xx"/>' + "".join(f"""<let name="a{n}" value="$(eval &quot;'$(var a{n - 1})' + '$(var a{n - 1})'&quot;)"/>""" for n in range(1, LEVELS)) + f'<node pkg="a" exec="b" name="$(var a{LEVELS - 1})"/>')}),
    Bomb("many variables in many groups", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f'<let name="a{n}" value="b"/>' for n in range(10000)) + '<group><node pkg="a" exec="b"/></group>' * 10000)}),
    Bomb("many parameters for many nodes", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f'<set_parameter name="a{n}" value="b"/>' for n in range(6000)) + '<node pkg="a" exec="b"/>' * 10000)}),
    Bomb("many remaps for many nodes", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f'<set_remap from="a{n}" to="b{n}"/>' for n in range(6000)) + "".join(f'<node pkg="a" exec="b" name="n{n}"/>' for n in range(8000)))}),
    Bomb("much environment for many nodes", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f'<set_env name="A{n}" value="b"/>' for n in range(6000)) + '<node pkg="a" exec="$(env B c)"/>' * 10000)}),
    Bomb("many namespaces in one another", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch('<push_ros_namespace namespace="abcdefgh"/>' * 8000 + '<node pkg="a" exec="b"/>' * 8000)}),
    Bomb("many private parameters for many nodes", "import launch x.launch -o new", lambda: {"x.launch": _wrap_in_launch("".join(f'<param name="~a{n}" value="b"/>' for n in range(5000)) + '<node pkg="a" type="b" name="c"/>' * 5000)}),
    Bomb("many server parameters", "import launch x.launch -o new", lambda: {"x.launch": _wrap_in_launch("".join(f'<param name="/a/b/c{n}/d/e" value="b"/>' for n in range(10000)) + '<node pkg="a" type="b" name="a"/>')}),
    Bomb("server parameters far down", "import launch x.launch -o new", lambda: {"x.launch": _wrap_in_launch(f"""<param name="{'/a' * 20000}" value="b"/>""" * 15 + '<node pkg="a" type="b" name="a"/>')}),
    Bomb("one parameter file for many nodes", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch('<node pkg="a" exec="b"><param from="$(dirname)/p.yaml"/></node>' * 10000), "p.yaml": "/**:\n  ros__parameters:\n" + "".join(f"    a{n}: {n}\n" for n in range(20000))}),
    Bomb("wildcards in a parameter file", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f"""<node pkg="a" exec="b" name="{'a' * 60}{n}"><param from="$(dirname)/p.yaml"/></node>""" for n in range(3000))), "p.yaml": "".join(f"/{'*' * 30}/**/*a{n}:\n  ros__parameters: {{x: 1}}\n" for n in range(5000))}),
    Bomb("launch files in YAML with anchors", "import launch x.launch.yaml -o new", lambda: {"x.launch.yaml": f"x:\n{_double_aliases()}launch: [*a39]\n".replace("\na", "\n  a")}),
    Bomb("components for containers that many start", XML_LAUNCH, lambda: {"x.launch.xml": _wrap_in_launch("".join(f'<node_container pkg="a" exec="b" name="c{n}" namespace=""><composable_node pkg="a" plugin="b" name="d{n}"/></node_container>' for n in range(6000)))}),
    Bomb("components loaded from Python", LAUNCH, _python("s = []", "for i in range(1000):", "    for j in range(8):", "        c = ComposableNodeContainer(name='c' + str(i) + str(j), namespace='', package='p', executable='e')", "        s.append(c)", "        s.append(LoadComposableNodes(target_container=c, composable_node_descriptions=[ComposableNode(package='p', plugin='q')]))")),
)
# fmt: on

# --- packages and sources


def _package(**files: str) -> Callable[[], Files]:
    manifest = "<package format='3'><name>a</name><version>1.0.0</version></package>"
    return lambda: {"a/package.xml": manifest, **{f"a/{name.replace('__', '.')}": text for name, text in files.items()}}


def _workspace(source: str, name: str = "node.py") -> Files:
    manifest = "<package format='3'><name>a</name><version>1.0.0</version></package>"
    if name.endswith(".py"):
        setup = (
            "from setuptools import setup\nsetup(name='a', entry_points={'console_scripts': ['run = a.node:main']})\n"
        )
        extra = {"a/setup.py": setup, "a/a/__init__.py": "", f"a/a/{name}": source}
    else:
        extra = {
            "a/CMakeLists.txt": f"project(a)\nadd_executable(run src/{name})\ninstall(TARGETS run DESTINATION lib/a)\n",
            f"a/src/{name}": source,
        }
    return {
        "a/package.xml": manifest,
        **extra,
        "a/launch/a.launch.xml": _wrap_in_launch('<node pkg="a" exec="run" name="n"/>'),
    }


def _program(*lines: str, head: str = "") -> Files:
    body = "".join(f"        {line}\n" for line in lines)
    source = (
        f"import rclpy\nfrom rclpy.node import Node\nfrom std_msgs.msg import String\n{head}\n"
        f"class Own(Node):\n    def __init__(self):\n        super().__init__('own')\n{body}\n"
        "def main():\n    rclpy.init()\n    rclpy.spin(Own())\n"
    )
    return _workspace(source)


def _cpp(*lines: str, head: str = "") -> Files:
    body = "".join(f"    {line}\n" for line in lines)
    source = (
        f'#include "rclcpp/rclcpp.hpp"\n#include "std_msgs/msg/string.hpp"\n{head}\n'
        f'class Own : public rclcpp::Node {{\n public:\n  Own() : Node("own") {{\n{body}  }}\n}};\n'
        "int main() { rclcpp::init(0, nullptr); rclcpp::spin(std::make_shared<Own>()); }\n"
    )
    return _workspace(source, "node.cpp")


PUBLISH = "self.create_publisher(String, t, 1)"
CPP_PUBLISH = "create_publisher<std_msgs::msg::String>(t, 1);"
WORKSPACE = "import workspace . -o new"
PACKAGE = "import package a -o new"
# fmt: off
SOURCE_BOMBS = (
    Bomb("variables of CMake doubled", PACKAGE, _package(CMakeLists__txt="project(a)\nset(x a b)\n" + "set(x ${x} ${x})\n" * LEVELS + "add_executable(run ${x})\n")),
    Bomb("variables of CMake appended", PACKAGE, _package(CMakeLists__txt="project(a)\nset(x a b)\n" + "list(APPEND x ${x} ${x})\n" * LEVELS + "add_executable(run ${x})\n")),
    Bomb("variables of CMake in one another", PACKAGE, _package(CMakeLists__txt="project(a)\n" + "".join(f"set(x{n} ${{x{n - 1}}}${{x{n - 1}}})\n" for n in range(LEVELS)) + f"add_executable(${{x{LEVELS - 1}}} a.cpp)\n"), is_quick=True),
    Bomb("loops of CMake", PACKAGE, _package(CMakeLists__txt="project(a)\nset(x " + "a " * 1000 + ")\n" + "foreach(i ${x})\n" * 50 + "add_executable(run_${i} a.cpp)\n" + "endforeach()\n" * 50)),
    Bomb("files that CMake looks for", PACKAGE, _package(CMakeLists__txt="project(a)\n" + 'file(GLOB_RECURSE x "/*/*/*/*" "../../../**")\n' * 1000 + "add_executable(run ${x})\n")),
    Bomb("a deep manifest", PACKAGE, lambda: {"a/package.xml": "<package><name>a</name>" + "<depend>" * 100000}),
    Bomb("a text of Python written in a text", WORKSPACE, lambda: _program("t = 'xx'", *["t = '%s%s' % (t, t)"] * LEVELS, PUBLISH), is_quick=True),
    Bomb("a text of Python filled in", WORKSPACE, lambda: _program("t = 'xx'", *["t = '{}{}'.format(t, t)"] * LEVELS, PUBLISH)),
    Bomb("a text of Python joined", WORKSPACE, lambda: _program("t = 'xx'", *["t = ''.join([t, t])"] * LEVELS, PUBLISH)),
    Bomb("a text of Python times a number", WORKSPACE, lambda: _program("t = 'x' * 10**10", "t = '%10000000000d' % 1", "t = f'{1:10000000000d}'", "t = 'x'.zfill(10**10)", "t = 'x'.ljust(10**10)", PUBLISH)),
    Bomb("a parameter of Python of itself", WORKSPACE, lambda: _program("t = 'x'", *[line for n in range(LEVELS) for line in (f"self.declare_parameter('p{n}', t)", f"t = self.get_parameter('p{n}').value", "t = t + t")], PUBLISH)),
    Bomb("a list of Python with stars", WORKSPACE, lambda: _program("s = ['x', 'y']", *["s = [*s, *s]"] * LEVELS, "for t in s:", f"    {PUBLISH}"), is_quick=True),
    Bomb("a list of Python of itself", WORKSPACE, lambda: _program("s = ['x', 'y']", *["s = [s, s]"] * LEVELS, "t = str(s) + f'{s}'", PUBLISH)),
    Bomb("loops of Python in loops", WORKSPACE, lambda: _program(*[f"{'    ' * n}for i{n} in range(1000):" for n in range(8)], f"{'    ' * 8}t = f'x{{i0}}'", f"{'    ' * 8}{PUBLISH}")),
    Bomb("comprehensions of Python", WORKSPACE, lambda: _program("s = [self.create_publisher(String, f'a{i}{j}{k}', 1) for i in range(1000) for j in range(1000) for k in range(1000)]", "s = [[[[self.create_publisher(String, f'a{i}{j}{k}', 1) for i in range(1000)] for j in range(1000)] for k in range(1000)] for l in range(1000)]")),
    Bomb("conditions of Python in a row", WORKSPACE, lambda: _program("t = 'x'", *[line for n in range(3000) for line in (f"if unknown({n}):", f"    t = t + '{n}'", "else:", "    t = t + 'z'")], PUBLISH)),
    Bomb("callers of callers in Python", WORKSPACE, lambda: {**_program("self.f40('x')", head=""), "a/a/node.py": str(_program("self.f40('x')")["a/a/node.py"]).replace("def main", "".join(f"    def f{n}(self, t):\n        self.f{n - 1}(t + 'a')\n        self.f{n - 1}(t + 'b')\n" for n in range(1, 41)) + f"    def f0(self, t):\n        {PUBLISH}\ndef main")}),
    Bomb("classes of Python that make one another", WORKSPACE, lambda: _program("C0(self)", head="".join(f"class C{n}:\n    def __init__(self, node):\n        self.a = C{n + 1}(node)\n        self.b = C{n + 1}(node)\n        node.create_publisher(String, 'x', 1)\n" for n in range(40)))),
    Bomb("classes of Python with many bases", WORKSPACE, lambda: {**_program(head="class B0:\n    pass\n" + "".join(f"class B{n}(B{n - 1}, B{n - 1}, B{max(0, n - 2)}):\n    pass\n" for n in range(1, LEVELS))), "a/a/other.py": f"from a.node import B{LEVELS - 1}\nclass D(B{LEVELS - 1}):\n    def x(self):\n        self.missing()\n"}),
    Bomb("a large table of Python", WORKSPACE, lambda: _program("s = [" + ", ".join(f"'t{n}'" for n in range(50000)) + "]", "for t in s:", "    for u in s:", "        self.create_publisher(String, t + u, 1)")),
    Bomb("modules of Python that import one another", WORKSPACE, lambda: {**_program(head="from a.m0 import *"), **{f"a/a/m{n}.py": f"from a.m{n + 1} import *\nfrom a.m{n // 2} import *\nX{n} = 1\n" for n in range(800)}}),
    Bomb("texts of C++ in a stream", WORKSPACE, lambda: _cpp('std::string t = "xx";', "std::stringstream s;", *["s << t << s.str();", "t = s.str();"] * LEVELS, CPP_PUBLISH)),
    Bomb("loops of C++ in loops", WORKSPACE, lambda: _cpp(*[f'for (auto t{n} : {{"a", "b", "c", "d"}}) {{' for n in range(20)], "create_publisher<std_msgs::msg::String>(std::string(t0) + t1, 1);", *["}"] * 20)),
    Bomb("wrappers of C++ that call one another", WORKSPACE, lambda: _cpp('f0(this, "x");', head="".join(f"void f{n}(rclcpp::Node* n, std::string t);\n" for n in range(40)) + "".join(f"void f{n}(rclcpp::Node* n, std::string t) {{\n" + "".join(f'  f{m}(n, t + "{m}");\n' for m in range(40)) + "  n->create_publisher<std_msgs::msg::String>(t, 1);\n}\n" for n in range(40)))),
    Bomb("templates of C++ in templates", WORKSPACE, lambda: _cpp("create_publisher<" + "std::vector<" * 5000 + "int" + ">" * 5000 + '>("x", 1);', head="".join(f"template <class T> class C{n} : public C{n + 1}<C{n + 1}<T>> {{}};\n" for n in range(40)) + "using A0 = int;\n" + "".join(f"using A{n} = std::pair<A{n - 1}, A{n - 1}>;\n" for n in range(1, LEVELS)) + f"A{LEVELS - 1} x;\n")),
    Bomb("open brackets of C++", WORKSPACE, lambda: _cpp("a(" * 60000 + "b<" * 60000)),
    Bomb("conditions of C++ in a row", WORKSPACE, lambda: _cpp('std::string t = "x";', *['if (unknown()) { t = t + "a"; } else { t = t + "b"; }'] * 5000, CPP_PUBLISH), is_quick=True),
)
# fmt: on

# --- models


def _aadl(body: str) -> Files:
    return {"m.aadl": f"package p public\n{body}\nend p;\n"}


def _xmi(body: str, attributes: str = "") -> Files:
    return {
        "m.uml": f'<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmlns:uml="http://www.omg.org/spec/UML/20131001" {attributes}><uml:Model xmi:id="m" name="m">{body}</uml:Model></xmi:XMI>'
    }


def _zip(**members: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in members.items():
            archive.writestr(name.replace("__", "."), data)
    return stream.getvalue()


AADL = "import aadl m.aadl -o new"
XMI = "import xmi m.uml -o new"
REQIF = "import reqif m.reqif"
# fmt: off
MODEL_BOMBS = (
    Bomb("a property text of 30 MB", AADL, lambda: _aadl('system s properties a => "' + "x" * 30000000 + '"; end s;')),
    Bomb("an open property text", AADL, lambda: _aadl('system s properties a => "' + 'x""\\\\' * 200000)),
    Bomb("quotes that close no text", AADL, lambda: {"m.aadl": "package p\npublic\n" + '\\"' * 300000 + "\nend p;\n"}, is_quick=True),
    Bomb("many features", AADL, lambda: _aadl("system s features " + "".join(f"f{n}: in data port; " for n in range(40000)) + "end s;")),
    Bomb("classifiers that extend one another", AADL, lambda: _aadl("system s0 features f0: in data port; end s0;\n" + "".join(f"system s{n} extends s{n - 1} features f{n}: in data port; end s{n};\n" for n in range(1, 8000)))),
    Bomb("refinements of refinements", AADL, lambda: _aadl("data d end d;\nsystem s0 features f: in data port d; end s0;\n" + "".join(f"system s{n} extends s{n - 1} features f: refined to in data port d; end s{n};\n" for n in range(1, 8000)))),
    Bomb("parts of parts", AADL, lambda: _aadl("thread t end t;\nprocess q0 end q0;\nprocess implementation q0.i subcomponents a: thread t; end q0.i;\nsystem s0 end s0;\nsystem implementation s0.i subcomponents a: process q0.i; end s0.i;\n" + "".join(f"system s{n} end s{n};\nsystem implementation s{n}.i subcomponents a: system s{n - 1}.i; b: system s{n - 1}.i; end s{n}.i;\n" for n in range(1, 38)))),
    Bomb("processes with many threads", AADL, lambda: _aadl("thread t features i: in data port; o: out data port; end t;\nprocess q end q;\nprocess implementation q.i subcomponents " + "".join(f"t{n}: thread t; " for n in range(5000)) + "connections " + "".join(f"c{n}: port t{n}.o -> t{n + 1}.i; " for n in range(4999)) + "end q.i;\nsystem s end s;\nsystem implementation s.i subcomponents " + "".join(f"q{n}: process q.i; " for n in range(200)) + "end s.i;\n")),
    Bomb("feature groups of feature groups", AADL, lambda: _aadl("feature group g0 features a: in data port; end g0;\n" + "".join(f"feature group g{n} features a: feature group g{n - 1}; b: feature group g{n - 1}; end g{n};\n" for n in range(1, 30)) + "device d features f: feature group g29; end d;\nsystem s end s;\nsystem implementation s.i subcomponents d: device d; end s.i;\n")),
    Bomb("constants of constants", AADL, lambda: {"m.aadl": "property set c is\n  a0: constant aadlinteger => 1;\n" + "".join(f"  a{n}: constant list of aadlinteger => (c::a{n - 1}, c::a{n - 1});\n" for n in range(1, LEVELS)) + f"end c;\npackage p public\nthread t properties Period => c::a{LEVELS - 1}; end t;\nend p;\n"}),
    Bomb("lists of lists", AADL, lambda: _aadl("system s properties a => " + "(" * 200000 + "1; end s;")),
    Bomb("large numbers", AADL, lambda: _aadl("thread t properties Period => " + "9" * 300000 + " ms; Deadline => 1e999999999 ms; Compute_Execution_Time => 2#" + "1" * 300000 + "# us .. 1 ms; end t;")),
    Bomb("data of data", AADL, lambda: _aadl("data d0 end d0;\n" + "".join(f"data d{n} end d{n};\ndata implementation d{n}.i subcomponents a: data d{n - 1}{('.i' if n > 1 else '')}; b: data d{n - 1}{('.i' if n > 1 else '')}; end d{n}.i;\n" for n in range(1, 40)) + "thread t features f: in data port d39.i; end t;\n")),
    Bomb("properties that apply to all", AADL, lambda: _aadl("thread t end t;\nprocess q end q;\nprocess implementation q.i subcomponents " + "".join(f"t{n}: thread t; " for n in range(2000)) + "properties " + "".join(f"Period => {n} ms applies to {', '.join(f't{m}' for m in range(n % 50, 2000, 50))}; " for n in range(2000)) + "end q.i;\nsystem s end s;\nsystem implementation s.i subcomponents q: process q.i; end s.i;\n")),
    Bomb("namespaces in scope", XMI, lambda: _xmi("".join(f'<packagedElement xmlns:b{n}="u:{n}"/>' for n in range(20000)), " ".join(f'xmlns:a{n}="u:{n}"' for n in range(20000))), is_quick=True),
    Bomb("namespaces in one another", XMI, lambda: _xmi("".join("<e " + " ".join(f'xmlns:a{n}x{m}="u"' for m in range(250)) + ">" for n in range(150)) + "</e>" * 150)),
    Bomb("a deep model", XMI, lambda: _xmi("<packagedElement>" * 100000)),
    Bomb("classes that are each other's parents", XMI, lambda: _xmi("".join(f'<packagedElement xmi:type="uml:Class" xmi:id="c{n}" name="c{n}"><generalization xmi:id="g{n}" general="c{(n + 1) % 5000}"/><generalization xmi:id="h{n}" general="c{(n + 2) % 5000}"/><ownedAttribute xmi:id="a{n}" name="a{n}" type="c{n // 2}"/></packagedElement>' for n in range(5000)))),
    Bomb("classes with twice the same parent", XMI, lambda: _xmi('<packagedElement xmi:type="uml:Component" xmi:id="c0" name="c0"><ownedAttribute xmi:type="uml:Port" xmi:id="p" name="p"/></packagedElement>' + "".join(f'<packagedElement xmi:type="uml:Component" xmi:id="c{n}" name="c{n}"><generalization xmi:id="g{n}" general="c{n - 1}"/><generalization xmi:id="h{n}" general="c{n - 1}"/></packagedElement>' for n in range(1, LEVELS)))),
    Bomb("classes that hold the one before twice", XMI, lambda: _xmi('<packagedElement xmi:type="uml:Component" xmi:id="c0" name="c0"/>' + "".join(f'<packagedElement xmi:type="uml:Component" xmi:id="c{n}" name="c{n}"><ownedAttribute xmi:id="a{n}" name="a" type="c{n - 1}" aggregation="composite"/><ownedAttribute xmi:id="b{n}" name="b" type="c{n - 1}" aggregation="composite"/></packagedElement>' for n in range(1, LEVELS)))),
    Bomb("interfaces that all components have", XMI, lambda: _xmi('<packagedElement xmi:type="uml:Interface" xmi:id="i" name="i"/>' + "".join(f'<packagedElement xmi:type="uml:Component" xmi:id="c{n}" name="c{n}"><interfaceRealization xmi:id="r{n}" contract="i"/></packagedElement><packagedElement xmi:type="uml:Usage" xmi:id="u{n}" client="c{n}" supplier="i"/>' for n in range(2000)))),
    Bomb("an archive of zeros", "import xmi m.mdzip -o new", lambda: {"m.mdzip": _zip(a__xmi=b"0" * 900000000)}),
    Bomb("deep requirements", REQIF, lambda: {"archgen.yaml": PROJECT, "m.reqif": '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"><CORE-CONTENT><REQ-IF-CONTENT><SPECIFICATIONS><SPECIFICATION IDENTIFIER="s"><CHILDREN>' + '<SPEC-HIERARCHY IDENTIFIER="h"><CHILDREN>' * 20000}),
    Bomb("deep formatted text of requirements", REQIF, lambda: {"archgen.yaml": PROJECT, "m.reqif": '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"><CORE-CONTENT><REQ-IF-CONTENT><SPEC-OBJECTS><SPEC-OBJECT IDENTIFIER="a"><VALUES><ATTRIBUTE-VALUE-XHTML><THE-VALUE>' + '<div xmlns="http://www.w3.org/1999/xhtml">' * 20000}),
    Bomb("an archive of requirements in one comment", "import reqif m.reqifz", lambda: {"archgen.yaml": PROJECT, "m.reqifz": _zip(a__reqif=b"<REQ-IF><!--" + b" " * 900000000 + b"--></REQ-IF>")}, said="a tag or comment in it is longer than 4 MB"),
    Bomb("requirements with a comment without an end", "import reqif m.reqif", lambda: {"archgen.yaml": PROJECT, "m.reqif": b"<REQ-IF><!--" + b" " * 300000000}, said="a tag or comment in it is longer than 4 MB"),
    Bomb("nodes of NoDL", "import nodl m.nodl.xml -o new", lambda: {"m.nodl.xml": '<interface version="1">' + "".join(f'<node name="n" executable="e{n}"><topic name="t" type="std_msgs/String" role="both"/></node>' for n in range(9000)) + "</interface>"}),
    Bomb("anchors in NoDL", "import nodl m.nodl.yaml -o new", lambda: {"m.nodl.yaml": "nodl_version: 2\n" + _double_aliases() + "parameters: *a39\n"}),
    Bomb("definitions of Orca", "import orca m.def -o new", lambda: {"m.def": "".join(f"DefaultComponentTag{'.a' * 20}{n}=" + "x" * 30 + "\n" for n in range(8000)) + "Config." + "a." * 100000 + "b=int\n" + "\\\n" * 50000}),
)
# fmt: on

# --- dumps, recordings, tables


def _table(rows: str, *, columns: str = "") -> bytes:
    return make_workbook({"S": f"{columns}<sheetData>{rows}</sheetData>"})


def _start(name: str, make: Callable[[], str | bytes]) -> Callable[[], Files]:
    return lambda: {name: make()}


RECORDED = (
    PROJECT + "groups: {a: {components: {b: {outputs: {o: T}}, c: {inputs: {i: b.o}}}}}\nnodes: {b: a.b, c: a.c}\n"
)
# fmt: off
TEXT_BOMBS = (
    Bomb("a dump of many nodes", "import ros2 d.txt -o new", lambda: {"d.txt": "".join(f"$ ros2 node info /n{n}\n/n{n}\n  Subscribers:\n    /t: std_msgs/msg/String\n  Publishers:\n    /t: std_msgs/msg/String\n" for n in range(6000))}),
    Bomb("a dump of parameters far down", "import ros2 d.txt -o new", lambda: {"d.txt": "$ ros2 param dump /n\n/n:\n  ros__parameters:\n" + "".join(f"{'  ' * n}a:\n" for n in range(2, 1300))}),
    Bomb("a dump of parameters with anchors", "import ros2 d.txt -o new", lambda: {"d.txt": "$ ros2 param dump /n\n/n:\n  ros__parameters:\n" + "".join(f"    {line}\n" for line in _double_aliases().splitlines())}),
    Bomb("a log of blanks", "timing --measured a.log", lambda: {"archgen.yaml": RECORDED, "a.log": ("average rate: 1" + " " * 100000 + "x\n") * 9}),
    Bomb("a log of many topics", "timing --measured a.log", lambda: {"archgen.yaml": RECORDED, "a.log": "".join(f"$ ros2 topic hz /t{n}\naverage rate: {n}.0\n" for n in range(20000))}),
    Bomb("a trace of open callbacks", "timing --measured a.txt", lambda: {"archgen.yaml": RECORDED, "a.txt": "".join(f'[12:00:{n % 60:02d}.{n:09d}] (+0.0) robot ros2:callback_start: {{ cpu_id = 0 }}, {{ vpid = {n}, vtid = {n}, procname = "p" }}, {{ callback = 0x{n:X}, is_intra_process = 0 }}\n' for n in range(8000))}),
    Bomb("a bag's description with anchors", "timing --measured metadata.yaml", lambda: {"archgen.yaml": RECORDED, "metadata.yaml": "rosbag2_bagfile_information:\n" + "".join(f"  {line}\n" for line in _double_aliases().splitlines())}),
    Bomb("a cell that is a long path", "init new --from t.csv --yes", lambda: {"t.csv": "Group,Component,Inputs\na,b," + "a/" * 400000 + "\n"}),
    Bomb("a wide table", "init new --from t.csv --yes", lambda: {"t.csv": "Group,Component,Input" + ",x" * 300000 + "\na,b,c" + "," * 300000}),
    Bomb("a long table", "init new --from t.csv --yes", lambda: {"t.csv": "Group,Component,Input,From\n" + "".join(f"a,b{n},i,b{n + 1}.o\n" for n in range(40000))}),
    Bomb("a cell of many ports", "init new --from t.csv --yes", lambda: {"t.csv": 'Group,Component,Inputs\na,b,"' + "; ".join(f"p{n} (T) from c{n}.o" for n in range(25000)) + '"\n'}),
    Bomb("a workbook of zeros", "init new --from t.xlsx --yes", lambda: {"t.xlsx": _zip(**{"xl/worksheets/sheet1.xml": b"0" * 900000000, "xl/workbook__xml": b"<workbook/>"})}),
    Bomb("a workbook with cells far away", "init new --from t.xlsx --yes", _start("t.xlsx", lambda: _table("".join(f'<row r="{n}"><c r="XFD{n}" t="inlineStr"><is><t>x</t></is></c></row>' for n in range(1, 10000))))),
    Bomb("a workbook with one text in all cells", "init new --from t.xlsx --yes", _start("t.xlsx", lambda: make_workbook({"S": "<sheetData>" + "".join(f'<row r="{n}">' + "".join(f'<c r="{c}{n}" t="s"><v>0</v></c>' for c in "ABCDEFGHIJ") + "</row>" for n in range(1, 20000)) + "</sheetData>"}, f"<si><t>{'x' * 30000}</t></si>"))),
    Bomb("a workbook with merged cells", "init new --from t.xlsx --yes", _start("t.xlsx", lambda: make_workbook({"S": '<sheetData><row r="1"><c r="A1" t="inlineStr"><is><t>Group</t></is></c></row></sheetData><mergeCells>' + '<mergeCell ref="A1:XFD1048576"/>' * 5000 + "</mergeCells>"}))),
    Bomb("a document with tables in tables", "init new --from t.docx --yes", _start("t.docx", lambda: make_document("<w:tbl><w:tr><w:tc>" * 20000 + "<w:p/>" + "</w:tc></w:tr></w:tbl>" * 20000))),
    Bomb("a document with a wide table", "init new --from t.docx --yes", _start("t.docx", lambda: make_document("<w:tbl><w:tr>" + '<w:tc><w:tcPr><w:gridSpan w:val="1000000000"/></w:tcPr><w:p><w:r><w:t>Group</w:t></w:r></w:p></w:tc>' * 100 + "</w:tr></w:tbl>"))),
)
# fmt: on

# --- the language itself, templates, passes, interface files, git


def _types(levels: int, *, word: str = "a") -> str:
    lines = ["  t0: {outputs: {o: T}}"]
    lines += [
        f"  t{number}: {{components: {{{word}: {{is: t{number - 1}}}, b: {{is: t{number - 1}}}}}}}"
        for number in range(1, levels)
    ]
    return "component_types:\n" + "\n".join(lines) + "\n"


def _project(text: str) -> Callable[[], Files]:
    return lambda: {"archgen.yaml": PROJECT + text}


BACKEND = "id: own\ntitle: Own\ndescription: Own.\nemitter: text\nmakes: file\nview: structure\nfiles: [{template: a.j2, path: a.txt}]\n"


def _backend(template: str) -> Callable[[], Files]:
    return lambda: {
        "archgen.yaml": RECORDED,
        "backends/own/backend.yaml": BACKEND,
        "backends/own/templates/a.j2": template,
    }


def _pass(text: str, project: str = RECORDED) -> Callable[[], Files]:
    return lambda: {"archgen.yaml": project, "passes/own.yaml": text}


# fmt: off
LANGUAGE_BOMBS = (
    Bomb("aliases of aliases", "check", _project("hints: \n" + "".join(f"  {line}\n" for line in _double_aliases().splitlines()))),
    Bomb("deep flow", "check", _project("groups: " + "{a: " * 100000)),
    Bomb("a marker of conflicts and blanks", "check", _project("<<<<<<< a" + " " * 900000 + "b\n")),
    Bomb("a pattern of open brackets", "check", _project("sources: ['" + "[" * 300000 + "']\n"), is_quick=True),
    Bomb("a pattern of stars", "check", _project("sources: ['" + "*a" * 450000 + "']\n")),
    Bomb("long numbers", "check", _project(f"groups: {{a: {{components: {{b: {{outputs: {{o: {{type: T, rate: {'9' * 300000} Hz}}}}, performance: {{wcet: 1e{'9' * 300000} ms}}}}}}}}}}\n")),
    Bomb("instances in instances", "check", lambda: {"archgen.yaml": PROJECT + _types(LEVELS) + f"groups: {{a: {{components: {{x: {{is: t{LEVELS - 1}}}}}}}}}\n"}),
    Bomb("generic types of generic types", "check", lambda: {"archgen.yaml": PROJECT + "types:\n  P: {generic: [A], fields: {a: A, b: A}}\n  T0: std_msgs/msg/String\n" + "".join(f"  T{n}: {{fields: {{a: 'P<T{n - 1}>', b: 'P<T{n - 1}>'}}}}\n" for n in range(1, LEVELS)) + f"groups: {{a: {{components: {{x: {{outputs: {{o: T{LEVELS - 1}}}}}}}}}}}\n"}),
    Bomb("generic parts in themselves", "check", _project("component_types: {t: {generic: [A], components: {a: {is: 't<t<A>>'}}}}\ngroups: {a: {components: {x: {is: 't<T>'}}}}\n")),
    Bomb("variants of many components", "check", lambda: {"archgen.yaml": PROJECT + "groups: {a: {components: {" + ", ".join(f"c{n}: {{outputs: {{o: T}}}}" for n in range(300)) + "}}}\nvariants: {" + ", ".join(f"v{n}: {{without: a.c{n}}}" for n in range(300)) + "}\n"}),
    Bomb("a chain through all", "check", lambda: {"archgen.yaml": PROJECT + "groups: {a: {components: {" + ", ".join(f"c{n}: {{outputs: {{o: T}}, inputs: {{i: {{from: [{', '.join(f'c{m}.o' for m in range(max(0, n - 8), n))}]}}}}}}" for n in range(150)) + "}}}\nchains: {k: {through: [a.c0, a.c149]}}\n"}),
    Bomb("libraries of libraries", "check", _project("libraries: {" + ", ".join(f"l{n}: {{path: .}}" for n in range(2000)) + "}\n")),
    Bomb("message files that hold one another", "check", lambda: {"archgen.yaml": PROJECT + "interfaces: ['msg']\ntypes: {T: p/msg/A39}\ngroups: {a: {components: {x: {outputs: {o: T}}}}}\n", "msg/package.xml": "<package><name>p</name></package>", "msg/msg/A0.msg": "int32 a\n", **{f"msg/msg/A{n}.msg": f"A{n - 1} a\nA{n - 1} b\n" for n in range(1, 40)}}),
    Bomb("a message of many fields", "check", lambda: {"archgen.yaml": PROJECT + "interfaces: ['msg']\n", "msg/package.xml": "<package><name>p</name></package>", "msg/msg/A.msg": "".join(f"int32[<=5] a{n} [1, 2]\n" for n in range(30000)) + "string a" + " " * 100000 + "=" * 100000 + "#" * 100000}),
    Bomb("a template that doubles", "export own", _backend("{% set ns = namespace(s='xx') %}{% for a in range(60) %}{% set ns.s = ns.s ~ ns.s %}{% endfor %}{{ ns.s }}")),
    Bomb("a template with a power", "export own", _backend("{{ 9 ** 9 ** 9 ** 9 }}{{ 'x' * 10**12 }}{{ '%10000000000d' % 1 }}")),
    Bomb("a template in itself", "export own", _backend("{% macro m(x) %}{{ m(x) }}{{ m(x) }}{% endmacro %}{{ m(1) }}{% include 'a.j2' %}")),
    Bomb("a pass that pairs all with all", "transform own --keep-going", lambda: {"archgen.yaml": PROJECT + "groups: {a: {components: {" + ", ".join(f"c{n}: {{outputs: {{o: T}}}}" for n in range(500)) + "}}}\n", "passes/own.yaml": "title: Own\nrules:\n  - find: {components: {$a: {outputs: {$p: {}}}, $b: {outputs: {$q: {}}}, $c: {outputs: {$r: {}}}, $d: {outputs: {$s: {}}}}}\n    let: {$name: '${a}${b}${c}${d}'}\n    unless: {components: {$a: {tags: [x]}}}\n    set: {components: {$a: {title: $name}}}\n"}),
    Bomb("a pass whose texts double", "transform own --keep-going", _pass("title: Own\nrules:\n  - find: {components: {$a: {}}}\n    let: {$x0: 'xx', " + ", ".join(f"$x{n}: '${{x{n - 1}}}${{x{n - 1}}}'" for n in range(1, LEVELS)) + f"}}\n    set: {{components: {{$a: {{title: $x{LEVELS - 1}}}}}}}\n"), is_quick=True),
    Bomb("instances taken apart", "transform flatten --keep-going -o t.yaml", lambda: {"archgen.yaml": PROJECT + _types(14) + "groups: {a: {components: {x: {is: t13}}}}\n"}),
)
# fmt: on

BOMBS: tuple[Bomb, ...] = (
    *PYTHON_BOMBS,
    *XML_LAUNCH_BOMBS,
    *SOURCE_BOMBS,
    *MODEL_BOMBS,
    *TEXT_BOMBS,
    *LANGUAGE_BOMBS,
)


def write_files(bomb: Bomb, folder: Path) -> None:
    """Write the files of a bomb into a folder."""
    for name, data in bomb.make_files().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
