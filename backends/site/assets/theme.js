// Before anything is drawn: the reader's choice of light or dark. Some browsers give file:// no storage.
"use strict";
(function () {
  try {
    var theme = localStorage.getItem("archgen-theme");
    if (theme === "light" || theme === "dark") document.documentElement.dataset.theme = theme;
  } catch (refused) {
    return;
  }
})();
