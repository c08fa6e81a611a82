"use strict";
// Click on a head sorts its table: numbers by value, the rest by text, empty cells last in both directions.
for (const head of document.querySelectorAll("thead th")) {
  head.addEventListener("click", () => {
    const ascending = head.getAttribute("aria-sort") !== "ascending";
    for (const other of head.parentNode.children) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    const key = row => row.cells[head.cellIndex].dataset.value ?? row.cells[head.cellIndex].textContent.trim();
    const isEmpty = text => text === "" || text === "—";
    const compare = (a, b) => {
      if (isEmpty(a) || isEmpty(b)) return isEmpty(a) - isEmpty(b);
      const order = Number(a) - Number(b) || (isNaN(a) || isNaN(b) ? a.localeCompare(b) : 0);
      return ascending ? order : -order;
    };
    const body = head.closest("table").tBodies[0];
    body.append(...[...body.rows].sort((a, b) => compare(key(a), key(b))));
  });
}
