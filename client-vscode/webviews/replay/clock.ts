// The current time of a replay, and its progress.

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export class Clock {
  time = 0;
  speed = 1;
  playing = false;

  constructor(
    public duration: number,
    private readonly changed: () => void,
  ) {}

  /** Seek to a time (s), at most the end. */
  seek(time: number): void {
    this.time = Math.min(this.duration, Math.max(0, time));
    this.changed();
  }

  /** Play or pause; at the end, restart. */
  toggle(): void {
    this.playing = !this.playing;
    this.seek(this.playing && this.time >= this.duration ? 0 : this.time);
  }

  pause(): void {
    this.playing = false;
    this.changed();
  }

  /** Advance by `elapsed` seconds of wall time. */
  advance(elapsed: number): void {
    if (this.playing) {
      const time = this.time + elapsed * this.speed;
      this.playing = time < this.duration;
      this.seek(time);
    }
  }
}
