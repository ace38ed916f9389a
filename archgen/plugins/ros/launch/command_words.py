"""Split command lines into words as a shell does, with `$(...)` in one piece: what it stands for is one word, too."""

from __future__ import annotations

from archgen.plugins.ros.launch.launch_values import OPEN


def split_words(text: str) -> list[str]:
    """Return the words of a command line; quotes and backslashes keep blanks together."""
    words: list[str] = []
    word: list[str] = []
    is_word, quote, position = False, "", 0
    while position < len(text):
        character = text[position]
        if quote != "'" and text.startswith(OPEN, position) and (end := text.find(")", position)) > 0:
            word.append(text[position : end + 1])
            is_word, position = True, end
        elif character == "\\" and quote != "'" and position + 1 < len(text):
            position += 1
            keeps_backslash = quote == '"' and text[position] not in '"\\$`'
            word.append(f"\\{text[position]}" if keeps_backslash else text[position])
            is_word = True
        elif character == quote:
            quote = ""
        elif character in "'\"" and not quote:
            quote, is_word = character, True
        elif character.isspace() and not quote:
            words += ["".join(word)] if is_word else []
            word, is_word = [], False
        else:
            word.append(character)
            is_word = True
        position += 1
    return [*words, "".join(word)] if is_word else words
