// The slider takes its pictures from the gallery below it, so that each is in the page once.
"use strict";
const byId = (id) => document.getElementById(id);
const slider = byId("slider"), at = byId("at");

function show(side, id) {
  const select = byId(side), source = byId(id), image = byId(side === "left" ? "over" : "under");
  select.value = id;
  image.src = source.src;
  image.alt = source.alt;
}
function move() {
  slider.style.setProperty("--at", at.value / 10 + "%");
  at.setAttribute("aria-valuetext", Math.round(at.value / 10) + " % of the left picture");
}
for (const side of ["left", "right"]) {
  byId(side).addEventListener("change", (event) => show(side, event.target.value));
}
for (const button of document.querySelectorAll("button[data-shows]")) {
  button.addEventListener("click", () => {
    show("left", "picture-truth");
    show("right", button.dataset.shows);
    slider.scrollIntoView({ block: "center", behavior: "smooth" });
    at.focus({ preventScroll: true });
  });
}
at.addEventListener("input", move);
show("left", byId("left").value);
show("right", byId("right").value);
move();
byId("compare").hidden = false;
