// Bundles src/ into one file, dist/report_template.html (or the file given). `softgrain report` puts the title
// and the runs in the places of <!--title--> and <!--runs-->.
import { bundle, here, writePage } from "./bundle.mjs";

const [script, style] = await Promise.all([bundle("src/main.ts"), bundle("src/style.css")]);
await writePage("src/page.html", { style, script }, process.argv[2] ?? here("dist/report_template.html"));
