import { Run } from "./run";
import { duration } from "./units";

/** Where each run came from, its case, and its numbers to take away. */
export function showProvenance(parent: HTMLElement, runs: Run[]): void {
  for (const run of runs) {
    const { run: record, case: caseText } = run.header;
    const block = element("section", "");
    block.append(element("h2", run.name));
    const list = element("dl", "");
    for (const [heading, words] of lines(run)) list.append(element("dt", heading), element("dd", words));
    const downloads = element("p", "");
    downloads.className = "downloads";
    const everyRow = run.header.rows_every > 1 ? ` (every ${run.header.rows_every}th row)` : "";
    downloads.append(
      download(`series.csv${everyRow}`, `${run.name}-series.csv`, run.header.series),
      download("case.toml", `${run.name}-case.toml`, caseText),
      download("run.json", `${run.name}-run.json`, JSON.stringify(record, null, 2) + "\n"),
    );
    const details = element("details", "");
    details.append(element("summary", "The case"), element("pre", caseText));
    block.append(list, downloads, details);
    parent.append(block);
  }
}

function lines(run: Run): [string, string][] {
  const { run: record, points_merged, snapshots_every, damaged } = run.header;
  const found: [string, string | undefined][] = [
    ["state", [record.state, record.message].filter(Boolean).join(": ")],
    ["verdict", record.verdict],
    ["program", record.program && `softgrain ${record.program.version} (${record.program.commit})`],
    ["build", record.program && `${record.program.compiler}, ${record.program.flags}`],
    ["command", record.command?.join(" ")],
    [
      "date",
      record.started &&
        `${record.started.replace("T", " ").replace("Z", " UTC")}, ${duration(record.wall_seconds ?? 0)}`,
    ],
    [
      "machine",
      record.machine &&
        `${record.machine.cpu}, ${record.machine.threads} thread${record.machine.threads === 1 ? "" : "s"}`,
    ],
    [
      "page",
      [
        `${run.frames} snapshots`,
        snapshots_every > 1 ? `every ${snapshots_every}th of the run` : "",
        points_merged > 1 ? `${points_merged} material points drawn as one` : "",
        damaged > 0 ? `${damaged} damaged left out` : "",
      ]
        .filter(Boolean)
        .join(", "),
    ],
  ];
  return found.filter((line): line is [string, string] => Boolean(line[1]));
}

function element(tag: string, words: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = words;
  return made;
}

/** A link that gives a file made in the browser. */
function download(words: string, name: string, contents: string): HTMLElement {
  const link = document.createElement("a");
  link.textContent = words;
  link.download = name;
  link.href = "data:text/plain;charset=utf-8,";
  link.addEventListener("click", () => {
    link.href = URL.createObjectURL(new Blob([contents], { type: "text/plain" }));
  });
  return link;
}
