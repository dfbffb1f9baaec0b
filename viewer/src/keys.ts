interface Timeline {
  frame: number;
  frames: number;
  seek(frame: number): void;
  play(): void;
}

/** Space plays, arrows step (ten with shift), Home and End go to the ends. */
export function onKey(event: KeyboardEvent, timeline: Timeline): void {
  const target = event.target as HTMLElement;
  if (event.ctrlKey || event.metaKey || event.altKey || target.closest("select, textarea, input[type=text]"))
    return;
  const step = event.shiftKey ? 10 : 1;
  const goals: Record<string, number> = {
    ArrowRight: timeline.frame + step,
    ArrowLeft: timeline.frame - step,
    Home: 0,
    End: timeline.frames - 1,
  };
  if (event.key in goals) timeline.seek(goals[event.key]);
  else if (event.key === " " && !target.closest("button, input[type=checkbox], a, summary")) timeline.play();
  else return;
  event.preventDefault();
}
