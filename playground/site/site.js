// What the pages do: the search, the list of pages, the buttons that copy, and the scene that runs.

import "./search.js";
import "./contents.js";
import "./copy.js";
import "./hero.js";
