package archgen.runtime;

import java.lang.reflect.InvocationTargetException;
import java.lang.reflect.ParameterizedType;
import java.lang.reflect.RecordComponent;
import java.lang.reflect.Type;
import java.math.BigDecimal;
import java.math.MathContext;
import java.math.RoundingMode;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.Map;

/** Values of ports as text, and back. */
public final class Values {
    private static final int MOST_DIGITS = 17;
    private static final int LEAST_PLAIN_EXPONENT = -4;
    private static final int MOST_PLAIN_EXPONENT = 16;

    private Values() {}

    /**
     * Read a value.
     *
     * @param text the value as JSON; what a record lacks has its default
     * @param type the type that it must have
     * @return the value
     */
    public static Object read(String text, Class<?> type) {
        if (type == Object.class) {
            throw new SimulationException("a port of several types takes no values of a scenario");
        }
        return convert(Json.read(text), type, "the value");
    }

    private static Object convert(Object read, Type type, String name) {
        if (type == double.class || type == Double.class) {
            return Double.valueOf(expect(read, Json.Token.class, name, "a number").text());
        }
        if (type == long.class || type == Long.class) {
            return toLong(expect(read, Json.Token.class, name, "a whole number"), name);
        }
        if (type == boolean.class || type == Boolean.class) {
            return expect(read, Boolean.class, name, "true or false");
        }
        if (type == String.class) {
            return expect(read, String.class, name, "a text");
        }
        if (type instanceof ParameterizedType list) {
            List<Object> items = new ArrayList<>();
            for (Object item : expect(read, List.class, name, "a list")) {
                items.add(convert(item, list.getActualTypeArguments()[0], name));
            }
            return List.copyOf(items);
        }
        return toRecord(expect(read, Map.class, name, "an object"), (Class<?>) type, name);
    }

    private static <T> T expect(Object read, Class<T> type, String name, String wanted) {
        if (!type.isInstance(read)) {
            throw new SimulationException(name + " is not " + wanted);
        }
        return type.cast(read);
    }

    private static Long toLong(Json.Token token, String name) {
        try {
            if (token.isWhole()) {
                return Long.valueOf(token.text());
            }
        } catch (NumberFormatException problem) {
            throw new SimulationException(name + " has no place in 64 bits", problem);
        }
        throw new SimulationException(name + " is not a whole number");
    }

    private static Object toRecord(Map<?, ?> read, Class<?> type, String name) {
        RecordComponent[] components = type.getRecordComponents();
        for (Object key : read.keySet()) {
            if (Arrays.stream(components).noneMatch(each -> nameOf(each).equals(key))) {
                throw new SimulationException(name + " has no field " + write(key));
            }
        }
        try {
            Object defaults = type.getMethod("empty").invoke(null);
            Object[] values = new Object[components.length];
            Class<?>[] types = new Class<?>[components.length];
            for (int index = 0; index < components.length; index++) {
                RecordComponent component = components[index];
                Object given = read.get(nameOf(component));
                types[index] = component.getType();
                values[index] =
                        given == null
                                ? component.getAccessor().invoke(defaults)
                                : convert(given, component.getGenericType(), nameOf(component));
            }
            return type.getConstructor(types).newInstance(values);
        } catch (InvocationTargetException problem) {
            throw new SimulationException(name + ": " + problem.getCause().getMessage(), problem);
        } catch (ReflectiveOperationException problem) {
            throw new SimulationException(name + " cannot be read", problem);
        }
    }

    private static String nameOf(RecordComponent component) {
        Named named = component.getAnnotation(Named.class);
        return named == null ? component.getName() : named.value();
    }

    /**
     * Write a value as JSON of printable ASCII on one line. A number has the fewest digits that give it back.
     *
     * @param value what ports hold
     * @return the text
     */
    public static String write(Object value) {
        StringBuilder text = new StringBuilder();
        write(value, text);
        return text.toString();
    }

    private static void write(Object value, StringBuilder text) {
        if (value instanceof String words) {
            writeText(words, text);
        } else if (value instanceof Double number) {
            text.append(writeNumber(number));
        } else if (value instanceof List<?> items) {
            String separator = "[";
            for (Object item : items) {
                text.append(separator);
                write(item, text);
                separator = ",";
            }
            text.append(items.isEmpty() ? "[]" : "]");
        } else if (value instanceof Record fields) {
            writeRecord(fields, text);
        } else {
            text.append(value);
        }
    }

    private static void writeRecord(Record fields, StringBuilder text) {
        String separator = "{";
        for (RecordComponent component : fields.getClass().getRecordComponents()) {
            text.append(separator);
            writeText(nameOf(component), text);
            text.append(':');
            try {
                write(component.getAccessor().invoke(fields), text);
            } catch (ReflectiveOperationException problem) {
                throw new SimulationException(nameOf(component) + " cannot be written", problem);
            }
            separator = ",";
        }
        text.append(fields.getClass().getRecordComponents().length == 0 ? "{}" : "}");
    }

    private static void writeText(String words, StringBuilder text) {
        text.append('"');
        for (char unit : words.toCharArray()) {
            switch (unit) {
                case '"' -> text.append("\\\"");
                case '\\' -> text.append("\\\\");
                case '\n' -> text.append("\\n");
                case '\r' -> text.append("\\r");
                case '\t' -> text.append("\\t");
                case '\b' -> text.append("\\b");
                case '\f' -> text.append("\\f");
                default -> text.append(unit >= ' ' && unit < 0x7f ? String.valueOf(unit) : "\\u%04x".formatted((int) unit));
            }
        }
        text.append('"');
    }

    private static String writeNumber(double number) {
        if (Double.isNaN(number) || Double.isInfinite(number)) {
            return String.valueOf(number);
        }
        if (number == 0) {
            return 1 / number < 0 ? "-0.0" : "0.0";
        }
        BigDecimal exact = new BigDecimal(Math.abs(number));
        int count = 1;
        BigDecimal rounded = exact.round(new MathContext(count, RoundingMode.HALF_EVEN));
        while (count < MOST_DIGITS && rounded.doubleValue() != Math.abs(number)) {
            count++;
            rounded = exact.round(new MathContext(count, RoundingMode.HALF_EVEN));
        }
        BigDecimal shortest = rounded.stripTrailingZeros();
        String digits = shortest.unscaledValue().toString();
        int exponent = digits.length() - 1 - shortest.scale();
        return (number < 0 ? "-" : "") + place(digits, exponent);
    }

    private static String place(String digits, int exponent) {
        if (exponent < LEAST_PLAIN_EXPONENT || exponent >= MOST_PLAIN_EXPONENT) {
            String fraction = digits.length() > 1 ? "." + digits.substring(1) : "";
            return digits.charAt(0) + fraction + "e" + (exponent < 0 ? "-" : "+") + "%02d".formatted(Math.abs(exponent));
        }
        if (exponent < 0) {
            return "0." + "0".repeat(-exponent - 1) + digits;
        }
        String padded = digits + "0".repeat(Math.max(0, exponent + 1 - digits.length()));
        String fraction = padded.substring(exponent + 1);
        return padded.substring(0, exponent + 1) + "." + (fraction.isEmpty() ? "0" : fraction);
    }

    /**
     * Copy a list of a record, and check how long it is.
     *
     * @param <T> the type of its items
     * @param items the list
     * @param name the name of the field
     * @param least the least number of items
     * @param most the largest number of items
     * @return a copy that nobody changes
     */
    public static <T> List<T> copy(List<T> items, String name, int least, int most) {
        if (items.size() < least || items.size() > most) {
            String wanted = least == most ? "" + least : "at most " + most;
            throw new IllegalArgumentException(name + " has " + items.size() + " items instead of " + wanted);
        }
        return List.copyOf(items);
    }
}
