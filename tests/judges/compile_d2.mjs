// Compiles files of D2, and says how many shapes each has. Ends with 1 at the first that is wrong.
import fs from "node:fs";
import path from "node:path";
import { D2 } from "@terrastruct/d2";

const d2 = new D2();
for (const file of process.argv.slice(2)) {
  try {
    const { diagram } = await d2.compile(fs.readFileSync(file, "utf8"));
    console.log(`${path.basename(file)} ${diagram.shapes.length} shapes`);
  } catch (error) {
    console.log(`${file}: ${error.message}`);
    process.exit(1);
  }
}
process.exit(0);
