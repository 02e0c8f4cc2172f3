// Examples that run in place: the runner is part of the page for browsers (`docs/play/build`), which
// lies in the folder `play` of the book where it was built. Without it the chapters are read only.
(() => {
  const runs = document.querySelector("code.language-console");
  const files = document.querySelector("code[class*='file=']");
  if (!runs || !files) return;
  const runner = document.createElement("script");
  runner.src = (typeof path_to_root === "string" ? path_to_root : "") + "play/run_examples.js";
  document.head.append(runner);
})();
