package archgen.runtime;

import java.util.ArrayList;
import java.util.List;

/**
 * An output: what is sent arrives at its readers in the same instant.
 *
 * @param <T> the type of its values
 */
public final class OutPort<T> extends Port {
    private final Class<T> type;
    private final List<InPort<? super T>> readers = new ArrayList<>();

    OutPort(Component component, String name, Class<T> type) {
        super(component, name);
        this.type = type;
    }

    /**
     * Send a value. It arrives when what was sent before has arrived.
     *
     * @param value what is sent; never null
     */
    public void send(T value) {
        component.simulation().send(this, value);
    }

    Class<T> type() {
        return type;
    }

    void addReader(InPort<? super T> reader) {
        readers.add(reader);
    }

    List<InPort<? super T>> readers() {
        return readers;
    }
}
