;;; -*- lexical-binding: t -*-
;;; What a user of lsp-mode sees: an error and its fix, completion, hover, a definition, layout, a rename, a run.
(require 'lsp-mode)
(require 'xref)
(setq lsp-auto-guess-root t
      lsp-idle-delay 0.05
      lsp-response-timeout patience
      xref-prompt-for-identifier nil)

(defun visit (file)
  "Open FILE as a user does, and wait until lsp-mode takes part in it."
  (find-file file)
  (lsp--init-if-visible) ; what lsp-deferred leaves for when the buffer is shown
  (eventually (concat "the server attaches to " file)
    (and (lsp-workspaces) (seq-every-p (lambda (one) (eq (lsp--workspace-status one) 'initialized)) (lsp-workspaces)))))

(defun findings ()
  "Return the diagnostics of this buffer."
  (gethash (lsp--fix-path-casing buffer-file-name) (lsp-diagnostics t)))

(defun codes ()
  "Return the codes of the diagnostics of this buffer."
  (mapcar #'lsp:diagnostic-code? (findings)))

(defun act (title)
  "Carry out the action at point whose TITLE begins so."
  (let ((action (seq-find (lambda (one) (string-prefix-p title (lsp:code-action-title one)))
                          (lsp-code-actions-at-point))))
    (expect (concat "there is the action " title) action)
    (lsp-execute-code-action action)))

(visit "pickplace.bdd")
(overwrite "template: <pick-place>" "template: <pick-plaice>")
(eventually "a misspelt name is underlined" (equal (codes) '("unknown-name")))
(before "pick-plaice")
(act "Change to")
(eventually "its fix mends it" (and (null (codes)) (written "template: <pick-place>")))

(before "before <evt-pick-start>")
(forward-char (length "before <evt-pick-s"))
(delete-char (length "tart"))
(pcase-let ((`(,start ,end ,table . ,_) (lsp-completion-at-point)))
  (expect "events are completed"
          (equal (mapcar #'substring-no-properties (all-completions (buffer-substring start end) table))
                 '("evt-pick-start"))))
(insert "tart")

(before "part-to-bin")
(let ((hover (lsp-request "textDocument/hover" (lsp--text-document-position-params))))
  (expect "hover counts scenarios" (string-match-p "4 scenarios" (lsp--render-on-hover-content (lsp:hover-contents hover) t))))

(before "left_ws>")
(call-interactively #'lsp-find-definition)
(expect "a definition is found in the scene" (equal (buffer-name) "bench.scene"))
(expect "and there at its name" (looking-at "left_ws"))
(visit "bench.scene")

(switch-to-buffer "pickplace.bdd")
(let ((sound (buffer-substring-no-properties (point-min) (point-max))))
  (overwrite "    var robot" "  var   robot")
  (lsp-format-buffer)
  (expect "the layout is mended" (equal sound (buffer-substring-no-properties (point-min) (point-max)))))

(before "left_ws>")
(lsp-rename "near_ws")
(expect "a rename changes the model" (written "<places.near_ws>"))
(expect "and the scene" (with-current-buffer "bench.scene" (written "workspace near_ws")))

(overwrite "{ <cubes.cube0>, <balls.ball0> }" "{ <cubes.cube0> }")
(overwrite "{ <places.near_ws>, <places.right_ws> }" "{ <places.near_ws> }")
(overwrite "held by <robot>, after <evt-pick-end>" "held by <robot>, after <evt-place-end>")
(before "Scenario part-to-bin")
(act "Run scenario part-to-bin")
(eventually "a violated clause is underlined after a run" (member "clause-violated" (codes)))

(setq lsp-restart 'ignore)
(kill-emacs 0)
