interface Timeline {
  readonly frame: number;
  readonly frames: number;
  /** Frames. */
  readonly perSecond: number;
  seek(frame: number): void;
}

/** Plays frame after frame, until the last or a second press of the button. */
export class Player {
  playing = false;

  constructor(
    private button: HTMLButtonElement,
    private timeline: Timeline,
  ) {
    button.addEventListener("click", () => this.toggle());
  }

  toggle(): void {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? "❚❚" : "▶";
    this.button.ariaLabel = this.playing ? "Pause" : "Play";
    if (!this.playing) return;
    if (this.timeline.frame === this.timeline.frames - 1) this.timeline.seek(0);
    this.playFrom(performance.now(), this.timeline.frame);
  }

  private playFrom(begin: number, first: number): void {
    const { timeline } = this;
    const tick = (now: number) => {
      if (!this.playing) return;
      const frame = first + Math.floor(((now - begin) / 1000) * timeline.perSecond);
      if (frame > timeline.frame) timeline.seek(frame);
      if (timeline.frame >= timeline.frames - 1) this.toggle();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
}
