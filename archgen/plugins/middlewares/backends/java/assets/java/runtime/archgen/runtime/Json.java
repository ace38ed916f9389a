package archgen.runtime;

import java.util.ArrayList;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;

/** Reads JSON: to maps, lists, texts, booleans and numbers, which stay as they are written. */
final class Json {
    private static final int DEEPEST = 100;

    /** A number as it is written. */
    record Token(String text) {
        boolean isWhole() {
            return text.chars().allMatch(each -> each == '-' || each >= '0' && each <= '9');
        }
    }

    private final String text;
    private int position;
    private int depth;

    private Json(String text) {
        this.text = text;
    }

    static Object read(String text) {
        Json json = new Json(text);
        Object value = json.readValue();
        json.skipBlanks();
        if (json.position < text.length()) {
            throw json.problem("something follows the value");
        }
        return value;
    }

    private Object readValue() {
        skipBlanks();
        if (++depth > DEEPEST) {
            throw problem("it is nested too deeply");
        }
        Object value =
                switch (peek()) {
                    case '{' -> readObject();
                    case '[' -> readArray();
                    case '"' -> readText();
                    case 't' -> readWord("true", Boolean.TRUE);
                    case 'f' -> readWord("false", Boolean.FALSE);
                    default -> readNumber();
                };
        depth--;
        return value;
    }

    private Map<String, Object> readObject() {
        Map<String, Object> values = new LinkedHashMap<>();
        position++;
        skipBlanks();
        if (peek() == '}') {
            position++;
            return values;
        }
        while (true) {
            skipBlanks();
            if (peek() != '"') {
                throw problem("a name in double quotes is missing");
            }
            String name = readText();
            skipBlanks();
            expect(':');
            Object value = readValue();
            if (values.put(name, value) != null) {
                throw problem("a name stands twice");
            }
            skipBlanks();
            if (peek() == '}') {
                position++;
                return values;
            }
            expect(',');
        }
    }

    private List<Object> readArray() {
        List<Object> values = new ArrayList<>();
        position++;
        skipBlanks();
        if (peek() == ']') {
            position++;
            return values;
        }
        while (true) {
            values.add(readValue());
            skipBlanks();
            if (peek() == ']') {
                position++;
                return values;
            }
            expect(',');
        }
    }

    private String readText() {
        StringBuilder read = new StringBuilder();
        position++;
        while (true) {
            char next = peek();
            if (next < ' ') {
                throw problem("a text has no end");
            }
            position++;
            if (next == '"') {
                return read.toString();
            }
            read.append(next == '\\' ? readEscape() : next);
        }
    }

    private char readEscape() {
        char kind = peek();
        position++;
        return switch (kind) {
            case '"', '\\', '/' -> kind;
            case 'n' -> '\n';
            case 't' -> '\t';
            case 'r' -> '\r';
            case 'b' -> '\b';
            case 'f' -> '\f';
            case 'u' -> readUnit();
            default -> throw problem("there is no such escape");
        };
    }

    private char readUnit() {
        String digits = text.substring(position, Math.min(position + 4, text.length()));
        if (!digits.matches("[0-9A-Fa-f]{4}")) {
            throw problem("four hexadecimal digits are missing");
        }
        position += 4;
        return (char) Integer.parseInt(digits, 16);
    }

    private Object readWord(String word, Object value) {
        if (!text.startsWith(word, position)) {
            throw problem("this is no value");
        }
        position += word.length();
        return value;
    }

    private Token readNumber() {
        for (String word : List.of("NaN", "Infinity", "-Infinity")) {
            if (text.startsWith(word, position)) {
                position += word.length();
                return new Token(word);
            }
        }
        int start = position;
        while (position < text.length() && "+-.0123456789eE".indexOf(text.charAt(position)) >= 0) {
            position++;
        }
        String number = text.substring(start, position);
        if (!number.matches("-?(0|[1-9][0-9]*)(\\.[0-9]+)?([eE][+-]?[0-9]+)?")) {
            position = start;
            throw problem("this is no value");
        }
        return new Token(number);
    }

    private void skipBlanks() {
        while (position < text.length() && " \t\r\n".indexOf(text.charAt(position)) >= 0) {
            position++;
        }
    }

    private char peek() {
        return position < text.length() ? text.charAt(position) : '\0';
    }

    private void expect(char expected) {
        if (peek() != expected) {
            throw problem("'" + expected + "' is missing");
        }
        position++;
    }

    private SimulationException problem(String what) {
        return new SimulationException("character " + (position + 1) + " of the value: " + what);
    }
}
