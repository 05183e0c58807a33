;;; -*- lexical-binding: t -*-
;;; What a user of eglot sees: an error and its fix, completion, hover, a definition, layout, a rename, a run.
(require 'eglot)
(require 'xref)
(setq eglot-confirm-server-initiated-edits nil
      eglot-connect-timeout patience
      jsonrpc-default-request-timeout patience
      xref-prompt-for-identifier nil)

(find-file "pickplace.bdd")
(run-hooks 'post-command-hook) ; where eglot-ensure connects
(eventually "the server attaches" (eglot-current-server))

(defun changes-sent ()
  "Send what has changed, which Emacs does where it is idle."
  (dolist (buffer (seq-filter #'buffer-file-name (buffer-list)))
    (with-current-buffer buffer (eglot--signal-textDocument/didChange))))

(defun findings ()
  "Return the codes of the diagnostics of this buffer."
  (changes-sent)
  (flymake-start)
  (mapcar (lambda (found) (plist-get (cdr (assoc 'eglot-lsp-diag (eglot--diag-data found))) :code))
          (flymake-diagnostics)))

(defun act (kind title)
  "Carry out the action of KIND at point whose TITLE begins so."
  (let* ((actions (eglot-code-actions (point) (point) kind))
         (action (seq-find (lambda (one) (string-prefix-p title (plist-get one :title))) actions))
         (last-nonmenu-event ?\r)) ; chosen with the keyboard
    (expect (concat "there is the action " title) action)
    (cl-letf (((symbol-function 'completing-read) (lambda (&rest _) (plist-get action :title))))
      (eglot--read-execute-code-action actions (eglot-current-server)))))

(overwrite "template: <pick-place>" "template: <pick-plaice>")
(eventually "a misspelt name is underlined" (equal (findings) '("unknown-name")))
(before "pick-plaice")
(act "quickfix" "Change to")
(eventually "its fix mends it" (and (null (findings)) (written "template: <pick-place>")))

(before "before <evt-pick-start>")
(forward-char (length "before <evt-pick-s"))
(delete-char (length "tart"))
(completion-at-point)
(expect "events are completed" (written "before <evt-pick-start>"))

(before "part-to-bin")
(let (told)
  (eglot-hover-eldoc-function (lambda (words &rest _) (setq told (format "%s" words))))
  (eventually "hover counts scenarios" (and told (string-match-p "4 scenarios" told))))

(before "left_ws>")
(call-interactively #'xref-find-definitions)
(expect "a definition is found in the scene" (equal (buffer-name) "bench.scene"))
(expect "and there at its name" (looking-at "left_ws"))
(run-hooks 'post-command-hook) ; the scene is now open for the server, too
(eventually "eglot manages the scene" (eglot-managed-p))

(switch-to-buffer "pickplace.bdd")
(let ((sound (buffer-string)))
  (overwrite "    var robot" "  var   robot")
  (eglot-format-buffer)
  (expect "the layout is mended" (equal sound (buffer-string))))

(before "left_ws>")
(eglot-rename "near_ws")
(expect "a rename changes the model" (written "<places.near_ws>"))
(expect "and the scene" (with-current-buffer "bench.scene" (written "workspace near_ws")))

(overwrite "{ <cubes.cube0>, <balls.ball0> }" "{ <cubes.cube0> }")
(overwrite "{ <places.near_ws>, <places.right_ws> }" "{ <places.near_ws> }")
(overwrite "held by <robot>, after <evt-pick-end>" "held by <robot>, after <evt-place-end>")
(before "Scenario part-to-bin")
(changes-sent)
(act nil "Run scenario part-to-bin")
(eventually "a violated clause is underlined after a run" (member "clause-violated" (findings)))

(eglot-shutdown (eglot-current-server))
(kill-emacs 0)
