package archgen.runtime;

import java.math.BigDecimal;
import java.util.Map;
import java.util.regex.Matcher;
import java.util.regex.Pattern;

/** What comes from outside of the architecture: a text with a line for each value. */
public final class Scenario {
    private static final Pattern LINE =
            Pattern.compile("([^ \\t]+)[ \\t]+([<>])[ \\t]+([^ \\t]+)[ \\t]+(.*)", Pattern.DOTALL);
    private static final Pattern BLANK = Pattern.compile("[ \\t]*");
    private static final Pattern TIME = Pattern.compile("([0-9]{1,30}(?:\\.[0-9]{1,30})?)(ns|us|ms|s)?");
    private static final Map<String, Integer> DIGITS = Map.of("ns", 0, "us", 3, "ms", 6, "s", 9);

    private Scenario() {}

    /**
     * Give a run what a scenario says.
     *
     * @param text lines as {@code 100ms < group.component.input VALUE}
     * @param name the name of the file
     * @param simulation the run
     */
    public static void apply(String text, String name, Simulation simulation) {
        int number = 0;
        for (String raw : text.split("\n", -1)) {
            number++;
            String line = raw.endsWith("\r") ? raw.substring(0, raw.length() - 1) : raw;
            if (BLANK.matcher(line).matches() || line.startsWith("#")) {
                continue;
            }
            try {
                applyLine(line, simulation);
            } catch (SimulationException problem) {
                throw new SimulationException(name + ":" + number + ": " + problem.getMessage(), problem);
            }
        }
    }

    private static void applyLine(String line, Simulation simulation) {
        Matcher parts = LINE.matcher(line);
        if (!parts.matches()) {
            throw new SimulationException("a line is TIME < INPUT VALUE or TIME > OUTPUT VALUE");
        }
        long timeNs = readTime(parts.group(1));
        if (parts.group(2).equals("<")) {
            simulation.arrive(timeNs, parts.group(3), parts.group(4));
        } else {
            simulation.emit(timeNs, parts.group(3), parts.group(4));
        }
    }

    /**
     * Read a time.
     *
     * @param text the time with its unit, such as {@code 0.5s}; without a unit nanoseconds
     * @return whole nanoseconds
     */
    public static long readTime(String text) {
        Matcher parts = TIME.matcher(text);
        if (!parts.matches()) {
            throw new SimulationException("a time is a number with ns, us, ms or s, not " + Values.write(text));
        }
        String unit = parts.group(2) == null ? "ns" : parts.group(2);
        try {
            return new BigDecimal(parts.group(1)).scaleByPowerOfTen(DIGITS.get(unit)).longValueExact();
        } catch (ArithmeticException problem) {
            throw new SimulationException("the time " + text + " is no whole number of nanoseconds", problem);
        }
    }
}
