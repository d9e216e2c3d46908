/// The options of the index, which must be the same where it is made and where it is read.
export const OPTIONS = { fields: ["title", "page", "text"], storeFields: ["title", "page", "url", "start"] };
