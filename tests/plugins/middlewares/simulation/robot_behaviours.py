"""A standard behaviour of the components of random architectures, in Java and in Python.

A component counts how often it is active, echoes texts, and sums what arrives: which code does so depends on the types of
its ports only.
"""

from __future__ import annotations

from pathlib import Path

from tests.plugins.middlewares.simulation.random_robots import Kind, Robot

JAVA_READS = {
    "Words": "text = each;",
    "Count": "total = Math.floorMod(total + Math.floorMod(each.n(), 1000003L), 1000003L);",
    "Level": "level = level * 0.5 + each.x() / 3.0 - each.small();",
    "Batch": "for (var item : each.levels()) { level = level - item.x(); } total += each.words().size(); level += each.pair().get(1);",
    "any": "total++;",
}
PYTHON_READS = {
    "Words": "text = each",
    "Count": "total = (total + each.n % 1000003) % 1000003",
    "Level": "self.level = self.level * 0.5 + each.x / 3.0 - each.small",
    "Batch": "self.level, total = functools.reduce(lambda level, item: level - item.x, each.levels, self.level) + each.pair[1], total + len(each.words)",
    "any": "total += 1",
}
JAVA_SENDS = {
    "Words": 'text + " " + total',
    "Count": "new MSGS.Count(total)",
    "Level": "new MSGS.Level(level * component.parameters.gain(), Math.sqrt(Math.abs(level)))",
    "Batch": (
        "new MSGS.Batch(List.of(new MSGS.Level(level, 0.5), MSGS.Level.empty().withX(level / 7.0)), List.of(text), total % 2 == 0, "
        "new MSGS.Mode(total % 3), List.of(level, (double) total), List.of(total % 256, 7L))"
    ),
}
PYTHON_SENDS = {
    "Words": 'text + " " + str(total)',
    "Count": "msgs.Count(n=total)",
    "Level": "msgs.Level(x=self.level * own.parameters.gain, small=math.sqrt(abs(self.level)))",
    "Batch": (
        "msgs.Batch(levels=[msgs.Level(self.level, 0.5), msgs.Level(x=self.level / 7.0)], words=[text], on=total % 2 == 0, "
        "mode=msgs.Mode(value=total % 3), pair=[self.level, float(total)], bytes=[total % 256, 7])"
    ),
}


def write_behaviours(robot: Robot, workspace: Path) -> None:
    """Write what the components of a robot do into its generated behaviours."""
    messages = f"{robot.name}.data.{robot.name}_msgs"
    for kind in robot.kinds:
        (java,) = (workspace / "java" / "src").rglob(f"{kind.class_name}Behaviour.java")
        java.write_text(_fill_java(kind, java.read_text("utf-8")).replace("MSGS", messages), "utf-8")
        snake_name = kind.class_name.lower().replace("inner", "_inner")
        (python,) = (workspace / "python").rglob(f"{snake_name}_behaviour.py")
        imports = (
            f"import functools\nimport math\n\nfrom {robot.name}_simulation.data import {robot.name}_msgs as msgs\n"
        )
        python.write_text(imports + _fill_python(kind, python.read_text("utf-8")), "utf-8")


def _fill_java(kind: Kind, written: str) -> str:
    work = ["count++;", "long total = count + component.nowNs() % 1000;", 'String text = "";']
    for index, each in enumerate(kind.inputs):
        work.append(f"for (var each : component.i{index}.fresh()) {{ {JAVA_READS[each]} }}")
        if each == "Count":
            work.append(f"total += component.i{index}.latest().map(each -> Math.floorMod(each.n(), 10L)).orElse(5L);")
    if "ask" in kind.calls:
        work.append("total = component.ask.call(new MSGS.AskRequest(total)).n();")
    if "go" in kind.calls:
        work.append("final double[] shares = {0.0};")
        work.append("var done = component.go.call(new MSGS.GoGoal(total), step -> shares[0] += step.share());")
        work.append("level += shares[0] + (done.done() ? 0.1 : 0.2);")
    work += [f"component.o{index}.send({JAVA_SENDS[each]});" for index, each in enumerate(kind.outputs)]
    filled = written.replace("        // F.", "\n".join(f"        {line}" for line in work))
    filled = filled.replace("component;\n\n", "component;\n    private long count;\n    private double level;\n\n", 1)
    filled = filled.replace(";\n\n", ";\n\nimport java.util.List;\n", 1)
    filled = filled.replace(
        "AskResponse.empty()", "AskResponse.empty().withN(Math.floorMod(request.n() * 3 + ++count, 1000003L))"
    )
    return filled.replace(
        "return GoResult.empty()",
        "feedback.accept(new MSGS.GoFeedback(request.to() / 7.0));\n"
        "        feedback.accept(new MSGS.GoFeedback(1e-7 * request.to()));\n"
        "        return new GoResult(request.to() % 2 == 0)",
    )


def _fill_python(kind: Kind, written: str) -> str:
    work = ["own = self.component", "self.count += 1", "total = self.count + own.now_ns % 1000", 'text = ""']
    for index, each in enumerate(kind.inputs):
        work += [f"for each in own.i{index}.fresh():", f"    {PYTHON_READS[each]}"]
        if each == "Count":
            work.append(f"total += own.i{index}.latest().n % 10 if own.i{index}.latest() else 5")
    if "ask" in kind.calls:
        work.append("total = own.ask.call(msgs.AskRequest(total)).n")
    if "go" in kind.calls:
        work += ["shares = []", "done = own.go.call(msgs.GoGoal(total), lambda step: shares.append(step.share)).done"]
        work.append(
            "self.level += functools.reduce(lambda all, each: all + each, shares, 0.0) + (0.1 if done else 0.2)"
        )
    work += [f"own.o{index}.send({PYTHON_SENDS[each]})" for index, each in enumerate(kind.outputs)]
    head = '"""Do what is done when it is active: read inputs, send outputs."""\n'
    filled = written.replace(head, "".join(f"{line}\n        " for line in work) + "return\n")
    filled = filled.replace("= component\n", "= component\n        self.count = 0\n        self.level = 0.0\n", 1)
    module = filled.partition("_data.")[0].split()[-1] + "_data"
    filled = filled.replace(
        f"return {module}.AskResponse()",
        "self.count += 1\n        return msgs.AskResponse((request.n * 3 + self.count) % 1000003)",
    )
    return filled.replace(
        f"return {module}.GoResult()",
        "feedback(msgs.GoFeedback(request.to / 7.0))\n        feedback(msgs.GoFeedback(1e-7 * request.to))\n"
        "        return msgs.GoResult(request.to % 2 == 0)",
    )
