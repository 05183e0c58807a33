// The page that a web view begins with: one script, one style sheet, and a policy that lets nothing else in.

export interface PageParts {
  readonly title: string;
  /** Address of the bundled script and of the style sheet beside it, as the web view may load them. */
  readonly script: string;
  readonly style: string;
  /** Where the web view's own files come from, for the policy. */
  readonly source: string;
  /** A word that nobody can guess; only scripts that carry it run. */
  readonly nonce: string;
}

/** Return the page as HTML. */
export function page({ title, script, style, source, nonce }: PageParts): string {
  const policy = `default-src 'none'; script-src 'nonce-${nonce}'; style-src ${source}`;
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="UTF-8">
<meta http-equiv="Content-Security-Policy" content="${escaped(policy)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="stylesheet" href="${escaped(style)}">
<title>${escaped(title)}</title>
</head>
<body><script nonce="${escaped(nonce)}" src="${escaped(script)}"></script></body>
</html>
`;
}

function escaped(text: string): string {
  return text.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;");
}
