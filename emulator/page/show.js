/* The page. */
if (location.hash === "#picture") {
  showPicture();
} else {
  showHead();
  showTiles();
  showPlan();
  showTimeline();
  showFaults();
  showEvents();
  showEnergy();
  showBytes();
  showLosses();
  showMapBytes();
  showLatency();
  showGallery();
  showNodes();
  $("cloud").closest("section").hidden = Boolean(summary.baseline); /* pictures make no cloud */
  showCloud($("cloud"), {splatAtOne: 3.2});
  if (DATA.cloud.count < DATA.cloud.of) $("cloud-note").textContent += `; ${number(DATA.cloud.count)} of ${number(DATA.cloud.of)} points`;
}
