package archgen.runtime;

import java.io.BufferedWriter;
import java.io.IOException;
import java.io.OutputStreamWriter;
import java.io.PrintStream;
import java.io.UncheckedIOException;
import java.io.Writer;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.function.Supplier;

/** Runs an architecture from the command line. */
public final class Command {
    private static final String USAGE = "usage: [SCENARIO] [--until TIME], such as scenario.txt --until 2s";

    private Command() {}

    /**
     * Run, and print the trace.
     *
     * @param assembly makes what is run
     * @param words the words of the command line
     * @param out gets the trace
     * @param err gets what went wrong
     * @return the exit status: 1 if the run went wrong, 2 if the words did
     */
    public static int run(Supplier<? extends Assembly> assembly, String[] words, PrintStream out, PrintStream err) {
        String scenario = null;
        String until = "1s";
        for (int index = 0; index < words.length; index++) {
            if (words[index].equals("--until") && index + 1 < words.length) {
                until = words[++index];
            } else if (scenario == null && !words[index].startsWith("-")) {
                scenario = words[index];
            } else {
                err.println(USAGE);
                return 2;
            }
        }
        Writer trace = new BufferedWriter(new OutputStreamWriter(out, StandardCharsets.US_ASCII));
        try {
            try {
                Simulation simulation = new Simulation(assembly.get(), trace);
                if (scenario != null) {
                    Scenario.apply(Files.readString(Path.of(scenario)), scenario, simulation);
                }
                simulation.run(Scenario.readTime(until));
            } finally {
                // What happened up to a mistake helps to find it.
                trace.flush();
            }
        } catch (SimulationException problem) {
            err.println(problem.getMessage());
            return 1;
        } catch (IOException | UncheckedIOException problem) {
            err.println("cannot read or write: " + problem);
            return 1;
        }
        return 0;
    }
}
