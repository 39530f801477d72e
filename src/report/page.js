// Play and pause; people who want less motion start with a pause.
"use strict";
const button = document.getElementById("play");
const clock = document.querySelector("x3d TimeSensor");
if (button && clock) {
  const play = (on) => {
    clock.setAttribute("enabled", String(on));
    button.textContent = on ? "Pause" : "Play";
    button.setAttribute("aria-pressed", String(!on));
  };
  button.addEventListener("click", () => play(clock.getAttribute("enabled") === "false"));
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) play(false);
  document.body.classList.add("plays");
}
