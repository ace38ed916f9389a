"""Checks of parameters against what the model allows."""


def check_range(name, value, lowest, highest):
    """Refuse a value out of its range, of a list each item. No value is no wrong one."""
    for each in _list_items(value):
        if not lowest <= each <= highest:
            raise ValueError(f"{name} is {each}, and not from {lowest} to {highest}")


def check_choice(name, value, choices):
    """Refuse a value that is none of some, of a list each item. No value is no wrong one."""
    for each in _list_items(value):
        if each not in choices:
            raise ValueError(f"{name} is {each}, and not one of {choices}")


def _list_items(value):
    if value is None:
        return ()
    return value if isinstance(value, (list, tuple)) else (value,)
