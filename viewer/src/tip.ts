// What stands beside the pointer.

/** Lines of a heading and what stands beside it, near a place of the canvas and within it. */
export function showTip(
  tip: HTMLElement,
  canvas: HTMLElement,
  { offsetX, offsetY }: { offsetX: number; offsetY: number },
  lines: [string, string][],
): void {
  tip.hidden = false;
  tip.replaceChildren(
    ...lines.map(([heading, words]) => {
      const line = document.createElement("div");
      line.append(
        Object.assign(document.createElement("span"), { textContent: heading }),
        Object.assign(document.createElement("b"), { textContent: words }),
      );
      return line;
    }),
  );
  const [width, height] = [tip.offsetWidth, tip.offsetHeight];
  const left = offsetX + 16 + width < canvas.clientWidth ? offsetX + 16 : offsetX - 16 - width;
  const top = Math.min(offsetY + 12, canvas.clientHeight - height);
  tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, top)}px)`;
}

export function hideTip(tip: HTMLElement): void {
  tip.hidden = true;
}
