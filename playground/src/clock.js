// The clock of a scene: time and frame, with play and pause.

/// Returns a clock. `ticked` is called before each frame of the screen while it plays.
export function makeClock(ticked) {
  let playing = false;
  let waiting = 0;
  let last = 0;
  const clock = {
    time: 0,
    frame: 0,
    get isPlaying() {
      return playing;
    },
    play(on) {
      if (on === playing) return;
      playing = on;
      cancelAnimationFrame(waiting);
      last = performance.now();
      if (on) waiting = requestAnimationFrame(tick);
    },
    set(time) {
      Object.assign(clock, { time, frame: Math.round(time * 60) });
    },
  };
  function tick(now) {
    waiting = requestAnimationFrame(tick);
    // A page in the background gets no frames; the scene goes on where it was.
    clock.time += Math.min(Math.max(0, now - last), 250) / 1000;
    clock.frame += 1;
    last = now;
    ticked();
  }
  return clock;
}
