"""New pictures a second on the live page in a headless Chromium, and the CPU time of its threads meanwhile.

Usage: rate.py PAGE [--choices grains=30] [--from STRAIN] [--seconds S] [--webgl] [--priority NICE]

--priority: of all threads of the browser, to measure on a machine that others use (root alone may go below 0)."""

import argparse
import os
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests"))
from browser import CHROMIUM, Browser, require_browser  # noqa: E402

COUNT = """(() => {
  const c = window.counted = {frames: 0, pictures: 0, since: performance.now(), step: live.picture.numbers.step};
  const draw = live.drawing.draw.bind(live.drawing);
  let last = null;
  live.drawing.draw = (picture, ...others) => {
    if (picture !== last) c.pictures += 1;
    last = picture;
    draw(picture, ...others);
  };
  const frame = () => { c.frames += 1; requestAnimationFrame(frame); };
  requestAnimationFrame(frame);
})()"""
FOUND = "({...counted, seconds: (performance.now() - counted.since) / 1000, now: live.picture.numbers, over: live.over})"


def threads(session):
    """{(process, thread): (name, CPU seconds)} of the processes of a session."""
    found = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            if int(stat.read_text().rpartition(")")[2].split()[3]) != session:
                continue
            for task in (stat.parent / "task").iterdir():
                name, _, rest = (task / "stat").read_text().partition("(")[2].rpartition(")")
                user, system = rest.split()[11:13]
                found[stat.parent.name, int(task.name)] = name, (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")
        except OSError:
            pass  # it has ended
    return found


def prefer(session, nice):
    for _, thread in threads(session):
        try:
            os.setpriority(os.PRIO_PROCESS, thread, nice)
        except ProcessLookupError:
            pass


def main():
    words = argparse.ArgumentParser(usage=__doc__)
    words.add_argument("page", type=Path)
    words.add_argument("--choices", default="")
    words.add_argument("--from", dest="strain", type=float, default=0.05)
    words.add_argument("--seconds", type=float, default=2.5)
    words.add_argument("--webgl", action="store_true")
    words.add_argument("--priority", type=int)
    options = words.parse_args()
    require_browser()
    with Browser(CHROMIUM, webgl=options.webgl) as browser:
        browser.call("Page.navigate", url=f"file://{options.page.resolve()}#{options.choices}")
        browser.wait("document.body && document.body.dataset.drawn !== undefined", 120)
        for action in ("document.querySelector('.squeeze').click()", COUNT):
            if options.priority is not None:
                prefer(browser.session, options.priority)
            browser.run(action)
            browser.wait(f"live.picture.numbers.strain > {options.strain} || live.over", 300)
        before = threads(browser.session)
        browser.run("Object.assign(counted, {frames: 0, pictures: 0, since: performance.now(), step: live.picture.numbers.step})")
        time.sleep(options.seconds)
        found = browser.run(FOUND)
        after = threads(browser.session)
    steps, seconds = found["now"]["step"] - found["step"], found["seconds"]
    print(f"{options.choices or 'defaults'}: {found['pictures'] / seconds:.1f} new pictures, {found['frames'] / seconds:.1f} frames, "
          f"{steps / seconds:.1f} steps a second, to a strain of {found['now']['strain']:.2f}, Phi {found['now']['phi']:.2f}")
    spent = {}
    for key, (name, cpu) in after.items():
        spent[name] = spent.get(name, 0) + cpu - before.get(key, (name, 0))[1]
    for name, cpu in sorted(spent.items(), key=lambda item: -item[1])[:6]:
        print(f"  {name:16} {1000 * cpu / max(1, found['pictures']):6.2f} ms of CPU time a picture")


if __name__ == "__main__":
    main()
