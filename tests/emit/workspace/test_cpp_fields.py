"""Where C++ takes a field: of what has the class by its words, and of what a call of the node answers with."""

from __future__ import annotations

import pytest

from archgen.emit.workspace.cpp_fields import find_field

CLASS = "my_msgs::srv::Mode"


@pytest.mark.parametrize(
    "code",
    [
        "void on(const my_msgs::srv::Mode::Response & answer) { use(answer.ok); }",
        "auto answer = std::make_shared<my_msgs::srv::Mode>(); answer->ok = true;",
        "auto future = node_->call_mode(request); auto answer = future.get(); use(answer->ok);",
        "auto future = node_->call_mode(request); use(future.get()->ok);",
        "node_->call_mode(request, [this](auto answer) { use(answer->ok); });",
    ],
)
def test_a_field_of_what_the_words_say_is_found(code: str) -> None:
    found = find_field(code, "ok", CLASS, ["call_mode"])
    assert found is not None
    assert code[found.end() :].startswith("ok")


@pytest.mark.parametrize(
    "code",
    [
        "void on(const other_msgs::msg::State & answer) { use(answer.ok); }",
        "auto future = node_->call_reset(request); use(future.get()->ok);",
        "auto future = node_->call_mode(request); use(future.get()->okay);",
        "bool ok = true; use(ok);",
    ],
)
def test_another_class_another_call_or_another_field_is_not(code: str) -> None:
    assert find_field(code, "ok", CLASS, ["call_mode"]) is None
