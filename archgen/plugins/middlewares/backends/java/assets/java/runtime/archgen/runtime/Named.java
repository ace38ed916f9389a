package archgen.runtime;

import java.lang.annotation.ElementType;
import java.lang.annotation.Retention;
import java.lang.annotation.RetentionPolicy;
import java.lang.annotation.Target;

/** What the model calls a field, where Java calls it otherwise. */
@Retention(RetentionPolicy.RUNTIME)
@Target(ElementType.RECORD_COMPONENT)
public @interface Named {
    /**
     * Return the name of the field in the model, and in scenarios and traces.
     *
     * @return the name
     */
    String value();
}
