/* The page. */
if (location.hash === "#picture") {
  showPicture();
} else {
  showHead();
  showTiles();
  showPlan();
  showTimeline();
  showEnergy();
  showBytes();
  showMapBytes();
  showLatency();
  showGallery();
  showNodes();
  $("cloud").closest("section").hidden = Boolean(summary.baseline); /* pictures make no cloud */
  showCloud($("cloud"), {nearness: 1, splatAtOne: 3.2, trim: 0.1});
  if (DATA.cloud.count < DATA.cloud.of) $("cloud-note").textContent += `; ${number(DATA.cloud.count)} of ${number(DATA.cloud.of)} points`;
}
