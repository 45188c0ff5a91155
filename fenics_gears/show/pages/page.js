"use strict";
// Tables: a click on a heading sorts by it, a second one the other way round.
for (const table of document.querySelectorAll("table.sortable")) {
  const headings = [...table.tHead.rows[0].cells], body = table.tBodies[0];
  headings.forEach((heading, column) => heading.querySelector("button").addEventListener("click", () => {
    const sign = heading.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    headings.forEach(each => each.removeAttribute("aria-sort"));
    heading.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    const key = row => row.cells[column].dataset.value === undefined ? row.cells[column].textContent : Number(row.cells[column].dataset.value);
    const compare = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), undefined, { numeric: true });
    const missing = value => value === "" || Number.isNaN(value);
    const rows = [...body.rows].map(row => [key(row), row]);
    // What has no value comes last, whichever way.
    rows.sort(([a], [b]) => missing(a) - missing(b) || sign * compare(a, b));
    body.append(...rows.map(([, row]) => row));
  }));
}

// Charts are images until they come near the window; then they are drawn anew, to be zoomed. What is printed is the image, whole on any paper.
(async () => {
  const packed = document.getElementById("library"), plots = [...document.querySelectorAll(".curves")];
  if (!packed) return;
  try {
    const bytes = Uint8Array.from(atob(packed.textContent), character => character.charCodeAt(0));
    const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(unpacked).text();
    document.head.append(script);
    packed.remove();
  } catch (error) {
    const trouble = document.getElementById("trouble");
    trouble.textContent = "Charts stay still images: to zoom them needs a browser of 2023 or later. (" + error + ")";
    trouble.hidden = false;
    return;
  }

  const drawn = new Set();
  const draw = plot => {
    if (drawn.has(plot)) return;
    drawn.add(plot);
    const figure = JSON.parse(plot.querySelector("script").textContent), name = plot.getAttribute("aria-label").replace(/[^\w]+/g, "_");
    plot.after(Object.assign(plot.querySelector("img"), { className: "still" }));
    plot.classList.add("drawn");
    plot.replaceChildren();
    plot.style.height = plot.style.minHeight;
    const range = shared[plot.dataset.linked];
    if (range) Object.assign(figure.layout.xaxis, { range, autorange: false });
    Plotly.newPlot(plot, figure.data, figure.layout, {
      responsive: true, displaylogo: false, displayModeBar: matchMedia("(hover: hover)").matches ? "hover" : false, modeBarButtonsToRemove: ["lasso2d", "select2d", "toggleSpikelines"],
      toImageButtonOptions: { format: "svg", filename: name },
    });
    if (plot.dataset.linked) plot.on("plotly_relayout", change => follow(plot, change));
  };

  // Plots over the same axis are zoomed together.
  const shared = {};
  let following = false;
  const follow = (plot, change) => {
    const group = plot.dataset.linked, free = change["xaxis.autorange"] === true;
    const range = change["xaxis.range"] || (change["xaxis.range[0]"] === undefined ? null : [change["xaxis.range[0]"], change["xaxis.range[1]"]]);
    if (following || !(free || range)) return;
    shared[group] = free ? null : range;
    following = true;
    const others = [...drawn].filter(each => each !== plot && each.dataset.linked === group);
    Promise.all(others.map(each => Plotly.relayout(each, free ? { "xaxis.autorange": true, "yaxis.autorange": true } : { "xaxis.range": [...range] })))
      .finally(() => { following = false; });
  };

  const near = new IntersectionObserver(entries => entries.filter(entry => entry.isIntersecting).forEach(entry => {
    near.unobserve(entry.target);
    draw(entry.target);
  }), { rootMargin: "800px" });
  plots.forEach(plot => near.observe(plot));
  window.addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach(each => { each.open = true; });
  });
  document.documentElement.dataset.ready = "yes";
})();
