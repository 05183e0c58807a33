;;; -*- lexical-binding: t -*-
;;; A breakpoint on a clause pauses a simulation in Emacs, at the clause.
(require 'cl-lib)

(defvar frames nil "The frames that were shown, the latest first: name and line.")
(defvar over nil)

(add-hook 'dap-stack-frame-changed-hook
          (lambda (session)
            (when-let ((frame (dap--debug-session-active-frame session)))
              (push (list (gethash "name" frame) (gethash "line" frame)) frames))))
(add-hook 'dap-terminated-hook (lambda (_) (setq over t)))

(find-file "pickplace.bdd")
(search-forward "in-hand:")
(let ((line (line-number-at-pos)))
  (dap-breakpoint-add)
  (dap-debug (cdr (assoc "RobBDD: the first scenario" dap-debug-template-configurations)))
  (eventually "the simulation pauses at the clause" (equal (car frames) (list "in-hand" line))))
(dap-continue (dap--cur-session) 1)
(eventually "it continues to its end" over)
