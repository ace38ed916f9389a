package archgen.runtime;

import java.util.List;
import java.util.Optional;

/** Checks values of parameters against what the model allows. */
public final class ParameterCheck {
    private ParameterCheck() {}

    /**
     * Refuse a value out of its range; of a list each item is checked.
     *
     * @param name the name of the parameter
     * @param value the value, or an {@link Optional} of it
     * @param lowest the lowest value that is allowed
     * @param highest the highest value that is allowed
     */
    public static void range(String name, Object value, double lowest, double highest) {
        for (Object each : itemsOf(value)) {
            double number = ((Number) each).doubleValue();
            if (!(number >= lowest && number <= highest)) {
                throw new IllegalArgumentException(
                        name + " is " + each + ", and not from " + lowest + " to " + highest);
            }
        }
    }

    /**
     * Refuse a value that is none of some; of a list each item is checked.
     *
     * @param name the name of the parameter
     * @param value the value, or an {@link Optional} of it
     * @param choices the values that are allowed
     */
    public static void choice(String name, Object value, Object... choices) {
        for (Object each : itemsOf(value)) {
            if (!List.of(choices).contains(each)) {
                throw new IllegalArgumentException(name + " is " + each + ", and not one of " + List.of(choices));
            }
        }
    }

    private static List<?> itemsOf(Object value) {
        if (value instanceof Optional<?> optional) {
            return optional.isPresent() ? itemsOf(optional.get()) : List.of();
        }
        return value instanceof List<?> items ? items : List.of(value);
    }
}
