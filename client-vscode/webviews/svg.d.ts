/** The text of a drawing, which the build puts into the page. */
declare module "*.svg" {
  const text: string;
  export default text;
}
